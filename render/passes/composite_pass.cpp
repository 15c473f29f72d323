// SPDX-License-Identifier: Apache-2.0
#include "render/passes/composite_pass.h"

namespace furrow::render {
namespace {

enum TextureUnit : GLuint { kSceneUnit = 0 };
enum UniformLocation : GLint { kExposure = 0, kHeight = 1 };

bool ShowsLight(View view) {
  return view == View::kFinal || view == View::kWeights || view == View::kWireframe;
}

}  // namespace

CompositePass::CompositePass(ShaderLibrary* shaders, GlDevice* device)
    : shaders_(shaders), device_(device), no_attributes_(gl::MakeVertexArray()) {}

FrameGraph::Handle CompositePass::Add(FrameGraph* graph, FrameGraph::Handle scene,
                                      const TextureDesc& scene_desc, const Settings& settings) {
  struct Data {
    FrameGraph::Handle scene;
    FrameGraph::Handle picture;
  };
  const CompositeShader shader{scene_desc.samples, ShowsLight(settings.view)};
  const Data data = graph->AddPass<Data>(
      "composite",
      [&](FrameGraph::Builder& builder, Data& pass) {
        pass.scene = scene;
        builder.Read(scene);
        const TextureDesc desc{scene_desc.width, scene_desc.height, PixelFormat::kRgba8, 1};
        pass.picture = builder.Write(builder.Create("picture", desc));
      },
      [this, shader, exposure = settings.exposure](const FrameGraph::Resources& resources,
                                                   const Data& pass) {
        const GLuint framebuffer = device_->Framebuffer(resources.Get(pass.picture), 0);
        return Draw(shader, exposure, resources.Get(pass.scene), framebuffer,
                    resources.Desc(pass.picture));
      });
  return data.picture;
}

Status CompositePass::Draw(const CompositeShader& shader, float exposure, TextureId scene,
                           GLuint framebuffer, const TextureDesc& target) {
  const Result<GLuint> program = shaders_->Get(shader);
  if (!program.ok()) return program.status();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, target.width, target.height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glUseProgram(*program);
  glUniform1f(kExposure, exposure);
  glUniform1i(kHeight, target.height);
  glBindTextureUnit(kSceneUnit, scene);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return {};
}

}  // namespace furrow::render
