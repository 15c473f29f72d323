// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/temporal_pass.h"

#include <cmath>

#include "render/gl/shader_program.h"

namespace furrow::render {
namespace {

constexpr GLint kFocus = 0;  // in temporal/neighbours.frag.glsl
constexpr GLint kDrawn = 0;  // in temporal/accumulate.frag.glsl and temporal/surround.frag.glsl

// The drawn rectangle in pixels of the picture, whose rows begin at the top, rounded outwards.
ScreenRect InPicture(const ScreenRect& rect, const TemporalFrame& frame, const TextureDesc& whole) {
  if (rect.empty()) return {};
  const float across = static_cast<float>(whole.width) / static_cast<float>(frame.width);
  const float up = static_cast<float>(whole.height) / static_cast<float>(frame.height);
  const auto floor = [](float x) { return static_cast<int>(std::floor(x)); };
  const auto ceil = [](float x) { return static_cast<int>(std::ceil(x)); };
  return {floor(static_cast<float>(rect.x0) * across),
          floor(static_cast<float>(frame.height - rect.y1) * up),
          ceil(static_cast<float>(rect.x1) * across),
          ceil(static_cast<float>(frame.height - rect.y0) * up)};
}

// The up to four rectangles of a picture around `rect`.
std::vector<ScreenRect> Around(const ScreenRect& rect, int width, int height) {
  if (rect.empty()) return {{0, 0, width, height}};
  return {{0, 0, width, rect.y0},
          {0, rect.y1, width, height},
          {0, rect.y0, rect.x0, rect.y1},
          {rect.x1, rect.y0, width, rect.y1}};
}

FrameGraph::Handle Import(FrameGraph* graph, const char* name, const KeptTexture& kept) {
  return kept.texture == 0 ? FrameGraph::Handle{} : graph->Import(name, kept.desc, kept.texture);
}

}  // namespace

FrameGraph::Handle AddTemporalPasses(FrameGraph* graph, const TemporalFrame& frame,
                                     const DrawnPicture& drawn, const TextureDesc& whole, int glow,
                                     Fullscreen* fullscreen) {
  const FrameGraph::Handle former_place = Import(graph, "former place", frame.former_place);
  const FrameGraph::Handle former_colour = Import(graph, "former picture", frame.former_colour);
  const FrameGraph::Handle place = Import(graph, "place", frame.place);
  const FrameGraph::Handle colour = Import(graph, "history", frame.colour);
  const TextureDesc small{frame.width, frame.height, PixelFormat::kRgba16F, 1};
  const std::vector<FrameGraph::Handle> near =
      fullscreen->AddPass(graph,
                          {.name = "neighbours",
                           .fragment = "temporal/neighbours.frag.glsl",
                           .defines = {Define("HAS_FORMER", frame.has_former())},
                           .reads = {drawn.picture, drawn.depth, drawn.motion, former_place},
                           .writes = {{"place", small, place}, {"mean", small}, {"spread", small}}},
                          [fullscreen, focus = drawn.focus_distance] {
                            glUniform1f(kFocus, focus);
                            fullscreen->Draw();
                          });
  const glm::vec4 drawn_pixels(static_cast<float>(frame.width) / static_cast<float>(whole.width),
                               static_cast<float>(frame.height) / static_cast<float>(whole.height),
                               frame.jitter.x, -frame.jitter.y);
  const ScreenRect inside =
      InPicture(drawn.bounds, frame, whole).Grown(glow, whole.width, whole.height);
  const TextureDesc picture{whole.width, whole.height, PixelFormat::kRgba8, 1};
  const std::vector<FrameGraph::Handle> around = fullscreen->AddPass(
      graph,
      {.name = "surround",
       .fragment = "temporal/surround.frag.glsl",
       .defines = {},
       .reads = {drawn.picture},
       .writes = {{"history", frame.colour.desc, colour}, {"picture", picture}}},
      [fullscreen, drawn_pixels, rects = Around(inside, whole.width, whole.height)] {
        glUniform4fv(kDrawn, 1, &drawn_pixels.x);
        for (const ScreenRect& rect : rects) fullscreen->Draw(rect);
      });
  return fullscreen
      ->AddPass(
          graph,
          {.name = "accumulate",
           .fragment = "temporal/accumulate.frag.glsl",
           .defines = {},
           .reads = {drawn.picture, near[0], near[1], near[2], former_colour},
           .writes = {{"history", frame.colour.desc, around[0]}, {"picture", picture, around[1]}}},
          [fullscreen, drawn_pixels, inside] {
            glUniform4fv(kDrawn, 1, &drawn_pixels.x);
            fullscreen->Draw(inside);
          })
      .back();
}

}  // namespace furrow::render
