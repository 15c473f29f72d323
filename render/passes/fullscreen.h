// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl/gl_device.h"
#include "render/gl/shader_library.h"
#include "render/graph/frame_graph.h"
#include "render/mesh/screen_rect.h"

namespace furrow::render {

// Declares a pass that covers the whole picture.
struct FullscreenPass {
  struct Target {
    std::string_view name;
    TextureDesc desc;
    FrameGraph::Handle into = {};  // written on top of this; an empty handle: a new texture
  };
  std::string_view name;
  std::string_view fragment;         // path of the fragment shader below shaders/
  std::vector<std::string> defines;  // "NAME VALUE" for the shader
  // Entry i is bound to texture unit i. An empty handle leaves its unit without a texture.
  std::vector<FrameGraph::Handle> reads;
  std::vector<Target> writes;  // all of the same size
  // The scene's depth buffer, of the same size as the targets: draws only pixels with a surface. An
  // empty handle draws all pixels.
  FrameGraph::Handle surface_z = {};
};

// Runs the passes that cover the whole picture.
class Fullscreen {
 public:
  // Both arguments must outlive this object. Needs a current context.
  Fullscreen(ShaderLibrary* shaders, GlDevice* device)
      : shaders_(shaders), device_(device), no_attributes_(gl::MakeVertexArray()) {}

  // Adds a pass. `draw` runs with the pass's program, targets and textures bound; it sets uniforms
  // and calls Draw(). Returns the written textures in the order of `pass.writes`. The pass fails if
  // ShaderLibrary reports an error.
  [[nodiscard]] std::vector<FrameGraph::Handle> AddPass(FrameGraph* graph,
                                                        const FullscreenPass& pass,
                                                        std::function<void()> draw);
  // AddPass() for a pass with one target; returns it.
  [[nodiscard]] FrameGraph::Handle AddSimplePass(FrameGraph* graph, const FullscreenPass& pass,
                                                 std::function<void()> draw) {
    return AddPass(graph, pass, std::move(draw)).front();
  }

  // Call only from a pass's `draw`. Draws the whole target, or a rectangle of pixels.
  void Draw();
  void Draw(const ScreenRect& rect);
  // Call only from a pass's `draw`. Fills target number `target` of FullscreenPass::writes with one
  // value.
  void Clear(int target, float r, float g, float b, float a);

 private:
  struct Handles {
    std::vector<FrameGraph::Handle> reads;
    std::vector<FrameGraph::Handle> writes;
    FrameGraph::Handle surface_z;
  };
  [[nodiscard]] Status Begin(std::string_view fragment, const std::vector<std::string>& defines,
                             const FrameGraph::Resources& resources, const Handles& handles);

  ShaderLibrary* shaders_;
  GlDevice* device_;
  gl::VertexArray no_attributes_;
  GLuint framebuffer_ = 0;
};

}  // namespace furrow::render
