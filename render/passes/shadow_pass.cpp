// SPDX-License-Identifier: Apache-2.0
#include "render/passes/shadow_pass.h"

namespace furrow::render {

FrameGraph::Handle ShadowPass::Add(FrameGraph* graph, const Settings& settings) {
  const int resolution = scene_->setup().shadow_resolution;
  struct Data {
    FrameGraph::Handle depth;
  };
  const Data data = graph->AddPass<Data>(
      "shadows",
      [&](FrameGraph::Builder& builder, Data& pass) {
        const TextureDesc desc{resolution * kNumLights, resolution, PixelFormat::kDepth32F, 1};
        pass.depth = builder.Write(builder.Create("shadow maps", desc));
      },
      [this, resolution, settings](const FrameGraph::Resources& resources, const Data& pass) {
        const GLuint framebuffer = device_->Framebuffer({}, resources.Get(pass.depth));
        const float nothing = 1.0f;
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
        glDepthMask(GL_TRUE);
        glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &nothing);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glEnable(GL_DEPTH_CLAMP);  // what stands nearer to the lamp than the stage casts as well
        Status status;
        for (int light = 0; light < settings.shadow.lamps && status.ok(); ++light) {
          glViewport(light * resolution, 0, resolution, resolution);
          status = scene_->DrawShadow(settings, light);
        }
        glDisable(GL_DEPTH_CLAMP);
        return status;
      });
  return data.depth;
}

}  // namespace furrow::render
