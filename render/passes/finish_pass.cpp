// SPDX-License-Identifier: Apache-2.0
#include "render/passes/finish_pass.h"

#include <algorithm>
#include <cmath>

#include <glm/vec4.hpp>

namespace furrow::render {
namespace {

constexpr GLint kLook = 0;      // in post/bloom.frag.glsl and post/show.frag.glsl
constexpr int kTileMargin = 4;  // pixels around each tile of the strip

// Bloom is wide and smooth, so a sixteenth of the pixels shows no difference. Tiny pictures keep
// one.
TextureDesc BloomDesc(const TextureDesc& desc) {
  return {std::max(desc.width / kBloomScale, 1), std::max(desc.height / kBloomScale, 1),
          PixelFormat::kRgba16F, 1};
}

}  // namespace

FrameGraph::Handle AddBloomPass(FrameGraph* graph, FrameGraph::Handle colour,
                                const TextureDesc& desc, const Settings& settings,
                                Fullscreen* fullscreen) {
  if (settings.bloom.strength <= 0.0f) return {};
  const TextureDesc small = BloomDesc(desc);
  const auto add = [&](const char* name, const char* target, FrameGraph::Handle in, bool bright,
                       const glm::vec4& look) {
    return fullscreen->AddSimplePass(graph,
                                     {.name = name,
                                      .fragment = "post/bloom.frag.glsl",
                                      .defines = {bright ? "BRIGHT 1" : "BRIGHT 0"},
                                      .reads = {in},
                                      .writes = {{target, small}}},
                                     [fullscreen, look] {
                                       glUniform4fv(kLook, 1, &look.x);
                                       fullscreen->Draw();
                                     });
  };
  const FrameGraph::Handle bright = add("bloom bright", "bloom bright", colour, true,
                                        {settings.bloom.threshold, settings.exposure, 0.0f, 0.0f});
  // The radius is a share of the picture's height, so that bloom looks the same at every size. The
  // shader divides by the square of sigma, hence the lower limit.
  const float sigma = std::max(settings.bloom.radius * static_cast<float>(small.height), 0.3f);
  const FrameGraph::Handle across =
      add("bloom x", "bloom x", bright, false, {1.0f, 0.0f, sigma, 0.0f});
  return add("bloom y", "bloom", across, false, {0.0f, 1.0f, sigma, 0.0f});
}

// Three standard deviations, as far as the shader blurs, and a pixel of bloom for its filter.
int BloomReach(const Settings& settings, int height) {
  if (settings.bloom.strength <= 0.0f) return 0;
  const float reach = 3.0f * settings.bloom.radius * static_cast<float>(height);
  return static_cast<int>(std::ceil(reach)) + 2 * kBloomScale;
}

FrameGraph::Handle AddShowPass(FrameGraph* graph, FrameGraph::Handle target, const ShowTarget& show,
                               const TextureDesc& desc, Fullscreen* fullscreen) {
  return fullscreen->AddSimplePass(
      graph,
      {.name = "show",
       .fragment = "post/show.frag.glsl",
       .defines = {"SHOWN " + std::to_string(static_cast<int>(show.kind))},
       .reads = {target},
       .writes = {{"shown", {desc.width, desc.height, PixelFormat::kRgba16F, 1}}}},
      [fullscreen, show, height = desc.height] {
        glUniform4f(kLook, show.scale, show.near_metres, show.far_metres,
                    static_cast<float>(height));
        fullscreen->Draw();
      });
}

FrameGraph::Handle AddFxaaPass(FrameGraph* graph, FrameGraph::Handle picture,
                               const TextureDesc& desc, Fullscreen* fullscreen) {
  return fullscreen->AddSimplePass(
      graph,
      {.name = "fxaa",
       .fragment = "post/fxaa.frag.glsl",
       .defines = {},
       .reads = {picture},
       .writes = {{"smooth picture", {desc.width, desc.height, PixelFormat::kRgba8, 1}}}},
      [fullscreen] { fullscreen->Draw(); });
}

FrameGraph::Handle AddStripPass(FrameGraph* graph, FrameGraph::Handle picture,
                                const std::vector<FrameGraph::Handle>& tiles, GlDevice* device) {
  if (tiles.empty()) return picture;
  struct Data {
    FrameGraph::Handle picture;
    std::vector<FrameGraph::Handle> tiles;
  };
  return graph
      ->AddPass<Data>(
          "strip",
          [&](FrameGraph::Builder& builder, Data& pass) {
            pass.tiles = tiles;
            for (const FrameGraph::Handle tile : tiles) builder.Read(tile);
            pass.picture = builder.Write(picture);
          },
          [device](const FrameGraph::Resources& resources, const Data& pass) {
            const GLuint target = device->Framebuffer(resources.Get(pass.picture), 0);
            const TextureDesc& whole = resources.Desc(pass.picture);
            // Row 0 is the top of the picture: the composite pass has flipped it. Tiles that do not
            // fit are left out.
            int top = kTileMargin;
            for (const FrameGraph::Handle tile : pass.tiles) {
              const TextureDesc& desc = resources.Desc(tile);
              const int left = whole.width - desc.width - kTileMargin;
              if (left < 0 || top + desc.height > whole.height) break;
              glBlitNamedFramebuffer(device->Framebuffer(resources.Get(tile), 0), target, 0, 0,
                                     desc.width, desc.height, left, top, left + desc.width,
                                     top + desc.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
              top += desc.height + kTileMargin;
            }
            return Status();
          })
      .picture;
}

}  // namespace furrow::render
