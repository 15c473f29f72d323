// SPDX-License-Identifier: Apache-2.0
#include "render/passes/finish_pass.h"

#include <algorithm>

namespace furrow::render {
namespace {

using Handle = FrameGraph::Handle;

constexpr GLint kLook = 0;      // in bloom.frag.glsl and show.frag.glsl
constexpr int kTileMargin = 4;  // pixels around a tile of the strip

TextureDesc BloomDesc(const TextureDesc& desc) {
  return {std::max(desc.width / kBloomScale, 1), std::max(desc.height / kBloomScale, 1),
          PixelFormat::kRgba16F, 1};
}

struct InOut {
  Handle in;
  Handle out;
};

// A pass that reads one texture and writes one; `set_uniforms` runs before it draws.
template <class SetUniforms>
Handle AddSimplePass(FrameGraph* graph, const char* name, const char* target, Handle in,
                     const TextureDesc& desc, const char* fragment,
                     const std::vector<std::string>& defines, Fullscreen* fullscreen,
                     SetUniforms set_uniforms) {
  return graph
      ->AddPass<InOut>(
          name,
          [&](FrameGraph::Builder& builder, InOut& pass) {
            pass.in = in;
            builder.Read(in);
            pass.out = builder.Write(builder.Create(target, desc));
          },
          [=](const FrameGraph::Resources& resources, const InOut& pass) {
            Status status = fullscreen->Begin(fragment, defines, resources, {pass.out}, {pass.in});
            if (!status.ok()) return status;
            set_uniforms();
            fullscreen->Draw();
            return status;
          })
      .out;
}

}  // namespace

Handle AddBloomPass(FrameGraph* graph, Handle colour, const TextureDesc& desc,
                    const Settings& settings, Fullscreen* fullscreen) {
  if (settings.bloom.strength <= 0.0f) return {};
  const TextureDesc small = BloomDesc(desc);
  Handle light = AddSimplePass(
      graph, "bloom bright", "bloom bright", colour, small, "bloom.frag.glsl", {"BRIGHT 1"},
      fullscreen, [threshold = settings.bloom.threshold, exposure = settings.exposure] {
        glUniform4f(kLook, threshold, exposure, 0.0f, 0.0f);
      });
  const float sigma = std::max(settings.bloom.radius * static_cast<float>(small.height), 0.3f);
  for (int axis = 0; axis < 2; ++axis) {
    light = AddSimplePass(graph, axis == 0 ? "bloom x" : "bloom y", axis == 0 ? "bloom x" : "bloom",
                          light, small, "bloom.frag.glsl", {"BRIGHT 0"}, fullscreen, [axis, sigma] {
                            glUniform4f(kLook, axis == 0 ? 1.0f : 0.0f, axis == 0 ? 0.0f : 1.0f,
                                        sigma, 0.0f);
                          });
  }
  return light;
}

Handle AddShowPass(FrameGraph* graph, Handle target, const ShowTarget& show,
                   const TextureDesc& desc, Fullscreen* fullscreen) {
  return AddSimplePass(
      graph, "show", "shown", target, {desc.width, desc.height, PixelFormat::kRgba16F, 1},
      "show.frag.glsl", {"SHOWN " + std::to_string(static_cast<int>(show.kind))}, fullscreen,
      [show] { glUniform4f(kLook, show.scale, show.near_metres, show.far_metres, 0.0f); });
}

Handle AddFxaaPass(FrameGraph* graph, Handle picture, const TextureDesc& desc,
                   Fullscreen* fullscreen) {
  return AddSimplePass(graph, "fxaa", "smooth picture", picture,
                       {desc.width, desc.height, PixelFormat::kRgba8, 1}, "fxaa.frag.glsl", {},
                       fullscreen, [] {});
}

Handle AddStripPass(FrameGraph* graph, Handle picture, const std::vector<Handle>& tiles,
                    GlDevice* device) {
  if (tiles.empty()) return picture;
  struct Data {
    Handle picture;
    std::vector<Handle> tiles;
  };
  return graph
      ->AddPass<Data>(
          "strip",
          [&](FrameGraph::Builder& builder, Data& pass) {
            pass.tiles = tiles;
            for (const Handle tile : tiles) builder.Read(tile);
            pass.picture = builder.Write(picture);
          },
          [device](const FrameGraph::Resources& resources, const Data& pass) {
            const GLuint target = device->Framebuffer(resources.Get(pass.picture), 0);
            const TextureDesc& whole = resources.Desc(pass.picture);
            int top = kTileMargin;
            for (const Handle tile : pass.tiles) {
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
