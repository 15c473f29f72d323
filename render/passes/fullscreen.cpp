// SPDX-License-Identifier: Apache-2.0
#include "render/passes/fullscreen.h"

#include "base/status.h"

namespace furrow::render {
namespace {

// The triangle that covers the picture lies at the far plane. With the test on, its fragments pass
// only where the scene drew something nearer.
void SetDepthTest(bool on_surface) {
  if (!on_surface) return glDisable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
}

}  // namespace

std::vector<FrameGraph::Handle> Fullscreen::AddPass(FrameGraph* graph, const FullscreenPass& pass,
                                                    std::function<void()> draw) {
  const auto set_up = [&](FrameGraph::Builder& builder, Handles& data) {
    data.reads = pass.reads;
    data.surface_z = pass.surface_z;
    if (data.surface_z.version >= 0) builder.Read(data.surface_z);
    for (const FrameGraph::Handle read : pass.reads) {
      if (read.version >= 0) builder.Read(read);
    }
    for (const FullscreenPass::Target& target : pass.writes) {
      const bool is_new = target.into.version < 0;
      data.writes.push_back(
          builder.Write(is_new ? builder.Create(target.name, target.desc) : target.into));
    }
  };
  // The pass runs after this function has returned, so everything is copied.
  const auto execute = [this, fragment = std::string(pass.fragment), defines = pass.defines,
                        draw = std::move(draw)](const FrameGraph::Resources& resources,
                                                const Handles& data) {
    Status status = Begin(fragment, defines, resources, data);
    if (status.ok()) draw();
    return status;
  };
  return graph->AddPass<Handles>(pass.name, set_up, execute).writes;
}

Status Fullscreen::Begin(std::string_view fragment, const std::vector<std::string>& defines,
                         const FrameGraph::Resources& resources, const Handles& handles) {
  const Result<GLuint> program = shaders_->GetFullscreen(fragment, defines);
  FURROW_RETURN_IF_ERROR(program);
  std::vector<TextureId> colours;
  for (const FrameGraph::Handle target : handles.writes) colours.push_back(resources.Get(target));
  const bool on_surface = handles.surface_z.version >= 0;
  framebuffer_ = device_->Framebuffer(colours, on_surface ? resources.Get(handles.surface_z) : 0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  const TextureDesc& desc = resources.Desc(handles.writes.front());
  glViewport(0, 0, desc.width, desc.height);
  SetDepthTest(on_surface);
  glDisable(GL_CULL_FACE);
  glUseProgram(*program);
  GLuint unit = 0;
  for (const FrameGraph::Handle texture : handles.reads) {
    // The scene passes leave samplers bound to some units, which would override the texture's
    // filtering.
    glBindSampler(unit, 0);
    glBindTextureUnit(unit++, texture.version < 0 ? 0 : resources.Get(texture));
  }
  // The core profile draws nothing without a vertex array, even if the shader makes the vertices.
  glBindVertexArray(no_attributes_.name());
  return {};
}

void Fullscreen::Draw() { glDrawArrays(GL_TRIANGLES, 0, 3); }

void Fullscreen::Draw(const ScreenRect& rect) {
  if (rect.empty()) return;
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);
  Draw();
  glDisable(GL_SCISSOR_TEST);
}

void Fullscreen::Clear(int target, float r, float g, float b, float a) {
  const float value[4] = {r, g, b, a};
  glClearNamedFramebufferfv(framebuffer_, GL_COLOR, target, value);
}

}  // namespace furrow::render
