// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "render/gl/gl_objects.h"
#include "render/graph/frame_graph.h"

namespace furrow::render {

// Implements the frame graph's textures with OpenGL textures, and owns the framebuffers that draw
// into them.
class GlDevice final : public FrameGraphDevice {
 public:
  [[nodiscard]] TextureId CreateTexture(const TextureDesc& desc) override;
  void DestroyTexture(TextureId texture) override;

  // Returns the name of a framebuffer that draws into the textures `colours`, in order, with the
  // depth texture `depth` (0: none). The device owns and caches it until one of the textures is
  // destroyed. This class needs a current context.
  [[nodiscard]] GLuint Framebuffer(std::span<const TextureId> colours, TextureId depth);
  [[nodiscard]] GLuint Framebuffer(TextureId colour, TextureId depth) {
    return Framebuffer(std::span(&colour, 1), depth);
  }

 private:
  std::map<TextureId, gl::Texture> textures_;
  // By attached textures, the depth texture first.
  std::map<std::vector<TextureId>, gl::Framebuffer> framebuffers_;
};

}  // namespace furrow::render
