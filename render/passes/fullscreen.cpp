// SPDX-License-Identifier: Apache-2.0
#include "render/passes/fullscreen.h"

namespace furrow::render {

Status Fullscreen::Begin(std::string_view fragment, const std::vector<std::string>& defines,
                         const FrameGraph::Resources& resources,
                         std::initializer_list<FrameGraph::Handle> targets,
                         std::initializer_list<FrameGraph::Handle> textures) {
  const Result<GLuint> program = shaders_->GetFullscreen(fragment, defines);
  if (!program.ok()) return program.status();
  std::vector<TextureId> colours;
  for (const FrameGraph::Handle target : targets) colours.push_back(resources.Get(target));
  framebuffer_ = device_->Framebuffer(colours, 0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  const TextureDesc& desc = resources.Desc(*targets.begin());
  glViewport(0, 0, desc.width, desc.height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glUseProgram(*program);
  GLuint unit = 0;
  for (const FrameGraph::Handle texture : textures) {
    glBindSampler(unit, 0);
    glBindTextureUnit(unit++, texture.version < 0 ? 0 : resources.Get(texture));
  }
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
