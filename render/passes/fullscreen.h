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

// A pass over the whole picture, as it is declared.
struct FullscreenPass {
  struct Target {
    std::string_view name;
    TextureDesc desc;
  };
  std::string_view name;
  std::string_view fragment;  // shader file
  std::vector<std::string> defines;
  std::vector<FrameGraph::Handle> reads;  // bound to units from 0; those without a version are none
  std::vector<Target> writes;             // made anew, of one size
  // Depth of the scene, of the targets' size: draws only where there is a surface. None:
  // everywhere.
  FrameGraph::Handle surface_z = {};
};

// What every pass over the whole picture does.
class Fullscreen {
 public:
  Fullscreen(ShaderLibrary* shaders, GlDevice* device)
      : shaders_(shaders), device_(device), no_attributes_(gl::MakeVertexArray()) {}

  // Adds a pass; `draw` runs with the pass's program current and its targets and textures bound: it
  // sets uniforms and calls Draw(). Returns what the pass wrote, in its order. The pass fails where
  // the ShaderLibrary does.
  [[nodiscard]] std::vector<FrameGraph::Handle> AddPass(FrameGraph* graph,
                                                        const FullscreenPass& pass,
                                                        std::function<void()> draw);
  // The same where there is one target.
  [[nodiscard]] FrameGraph::Handle AddSimplePass(FrameGraph* graph, const FullscreenPass& pass,
                                                 std::function<void()> draw) {
    return AddPass(graph, pass, std::move(draw)).front();
  }

  // Of a pass that runs. Draws the whole target, or only what lies within a rectangle of pixels.
  void Draw();
  void Draw(const ScreenRect& rect);
  // Fills a target of the pass with one value.
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
