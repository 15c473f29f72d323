// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

#include "render/frame_graph.h"
#include "render/gl_device.h"
#include "render/screen_rect.h"
#include "render/shader_library.h"

namespace furrow::render {

// What every pass over the whole picture does.
class Fullscreen {
 public:
  Fullscreen(ShaderLibrary* shaders, GlDevice* device)
      : shaders_(shaders), device_(device), no_attributes_(gl::MakeVertexArray()) {}

  // Makes the program of `fragment` current for drawing into the targets (of one size), and binds
  // `textures` to units from 0. Then set uniforms, then Draw(). Errors: of ShaderLibrary.
  [[nodiscard]] Status Begin(std::string_view fragment, const std::vector<std::string>& defines,
                             const FrameGraph::Resources& resources,
                             std::initializer_list<FrameGraph::Handle> targets,
                             std::initializer_list<FrameGraph::Handle> textures);
  // Draws the whole target, or only what lies within a rectangle of pixels.
  void Draw();
  void Draw(const ScreenRect& rect);
  // Fills a target of the last Begin() with one value.
  void Clear(int target, float r, float g, float b, float a);

  [[nodiscard]] ShaderLibrary* shaders() { return shaders_; }

 private:
  ShaderLibrary* shaders_;
  GlDevice* device_;
  gl::VertexArray no_attributes_;
  GLuint framebuffer_ = 0;
};

}  // namespace furrow::render
