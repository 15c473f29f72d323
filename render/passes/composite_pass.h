// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/frame_graph.h"
#include "render/gl_device.h"
#include "render/shader_library.h"

namespace furrow::render {

// Resolves the scene's samples and turns linear light into the 8-bit picture: exposure, tone map,
// sRGB curve; or, for the views that show data, nothing but the resolve. Writes the picture's rows
// from the top, as files and encoders have them.
class CompositePass {
 public:
  CompositePass(ShaderLibrary* shaders, GlDevice* device);

  // `scene` is multisampled. Returns the picture.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle scene,
                                       const TextureDesc& scene_desc, const Settings& settings);

 private:
  [[nodiscard]] Status Draw(const CompositeShader& shader, float exposure, TextureId scene,
                            GLuint framebuffer, const TextureDesc& target);

  ShaderLibrary* shaders_;
  GlDevice* device_;
  gl::VertexArray no_attributes_;
};

}  // namespace furrow::render
