// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "render/frame_graph.h"
#include "render/gl_objects.h"

namespace furrow::render {

// The frame graph's textures as OpenGL's, and the framebuffers that draw into them.
class GlDevice final : public FrameGraphDevice {
 public:
  [[nodiscard]] TextureId CreateTexture(const TextureDesc& desc) override;
  void DestroyTexture(TextureId texture) override;

  // A framebuffer with this colour and (0: none) depth texture; made once, kept while both live.
  [[nodiscard]] GLuint Framebuffer(TextureId colour, TextureId depth);

 private:
  std::map<TextureId, gl::Texture> textures_;
  std::map<std::pair<TextureId, TextureId>, gl::Framebuffer> framebuffers_;
};

}  // namespace furrow::render
