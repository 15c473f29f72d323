// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "render/gl/gl_objects.h"
#include "render/graph/frame_graph.h"

namespace furrow::render {

// The frame graph's textures as OpenGL's, and the framebuffers that draw into them.
class GlDevice final : public FrameGraphDevice {
 public:
  [[nodiscard]] TextureId CreateTexture(const TextureDesc& desc) override;
  void DestroyTexture(TextureId texture) override;

  // A framebuffer with these colours, drawn to in their order, and (0: none) depth texture; made
  // once, kept while all live.
  [[nodiscard]] GLuint Framebuffer(std::span<const TextureId> colours, TextureId depth);
  [[nodiscard]] GLuint Framebuffer(TextureId colour, TextureId depth) {
    return Framebuffer(std::span(&colour, 1), depth);
  }

 private:
  std::map<TextureId, gl::Texture> textures_;
  // By the textures attached, the depth's first.
  std::map<std::vector<TextureId>, gl::Framebuffer> framebuffers_;
};

}  // namespace furrow::render
