// SPDX-License-Identifier: Apache-2.0
#include "render/passes/fullscreen.h"

namespace furrow::render {

std::vector<FrameGraph::Handle> Fullscreen::AddPass(FrameGraph* graph, const FullscreenPass& pass,
                                                    std::function<void()> draw) {
  struct Data {
    std::vector<FrameGraph::Handle> reads;
    std::vector<FrameGraph::Handle> writes;
  };
  const auto set_up = [&](FrameGraph::Builder& builder, Data& data) {
    data.reads = pass.reads;
    for (const FrameGraph::Handle read : pass.reads) {
      if (read.version >= 0) builder.Read(read);
    }
    for (const FullscreenPass::Target& target : pass.writes) {
      data.writes.push_back(builder.Write(builder.Create(target.name, target.desc)));
    }
  };
  const auto execute = [this, fragment = std::string(pass.fragment), defines = pass.defines,
                        draw = std::move(draw)](const FrameGraph::Resources& resources,
                                                const Data& data) {
    Status status = Begin(fragment, defines, resources, data.writes, data.reads);
    if (status.ok()) draw();
    return status;
  };
  return graph->AddPass<Data>(pass.name, set_up, execute).writes;
}

Status Fullscreen::Begin(std::string_view fragment, const std::vector<std::string>& defines,
                         const FrameGraph::Resources& resources,
                         const std::vector<FrameGraph::Handle>& targets,
                         const std::vector<FrameGraph::Handle>& textures) {
  const Result<GLuint> program = shaders_->GetFullscreen(fragment, defines);
  if (!program.ok()) return program.status();
  std::vector<TextureId> colours;
  for (const FrameGraph::Handle target : targets) colours.push_back(resources.Get(target));
  framebuffer_ = device_->Framebuffer(colours, 0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  const TextureDesc& desc = resources.Desc(targets.front());
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
