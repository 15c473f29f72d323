// SPDX-License-Identifier: Apache-2.0
#include "render/passes/shadow_pass.h"

#include "render/mesh/mesh_morphs.h"
#include "render/request/subjects.h"

namespace furrow::render {
namespace {

void Append(const glm::mat4& matrix, std::vector<float>* values) {
  values->insert(values->end(), &matrix[0].x, &matrix[0].x + 16);
}

}  // namespace

ShadowPass::~ShadowPass() {
  if (maps_ != 0) device_->DestroyTexture(maps_);
}

std::vector<float> ShadowPass::Inputs(const FrameRequest& request) const {
  const FrameSetup& setup = scene_->setup();
  // Settings that change the geometry of casters, and then all matrices.
  std::vector<float> values = {
      static_cast<float>(request.settings.shadow.lamps), request.settings.detail.error_pixels,
      request.settings.detail.hair_shadow_texels, request.settings.shadow.normal_offset_mm};
  for (std::size_t light = 0; light < setup.shadows.size(); ++light) {
    const ShadowView& view = setup.shadows[light];
    const bool dark = setup.lighting.lights[light].radiance == glm::vec3(0.0f);
    values.insert(values.end(), {view.scale, view.near_plane, view.range,
                                 view.perspective ? 1.0f : 0.0f, dark ? 1.0f : 0.0f});
    Append(view.view, &values);
  }
  for (const NamedSubject& named : SubjectsOf(request)) {
    Append(named.subject->placement, &values);
    for (const glm::mat4& joint : named.subject->model) Append(joint, &values);
    for (const float shape : named.subject->shapes) values.push_back(DrawnShapeWeight(shape));
  }
  return values;
}

FrameGraph::Handle ShadowPass::Add(FrameGraph* graph, const FrameRequest& request) {
  const int resolution = scene_->setup().shadow_resolution;
  const TextureDesc desc{resolution * kNumLights, resolution, PixelFormat::kDepth32F, 1};
  if (maps_ == 0 || desc != desc_) {
    if (maps_ != 0) device_->DestroyTexture(maps_);
    maps_ = device_->CreateTexture(desc);
    desc_ = desc;
    drawn_.clear();
  }
  // Imported, because the maps outlive the frame. The pool would hand a transient texture to other
  // passes.
  const FrameGraph::Handle maps = graph->Import("shadow maps", desc, maps_);
  std::vector<float> inputs = Inputs(request);
  // The subdivision of displaced patches depends on the camera, and their position on wrinkle
  // weights.
  if (inputs == drawn_ && !request.settings.displacement.enabled) return maps;
  // Cleared first, so that a failed pass does not leave outdated maps marked as current.
  drawn_.clear();
  struct Data {
    FrameGraph::Handle maps;
  };
  return graph
      ->AddPass<Data>(
          "shadows",
          [&](FrameGraph::Builder& builder, Data& pass) { pass.maps = builder.Write(maps); },
          [this, settings = request.settings, inputs = std::move(inputs)](
              const FrameGraph::Resources& resources, const Data& pass) {
            Status status = Draw(settings, resources.Get(pass.maps));
            // Recorded only when the pass has run: the graph may cull it.
            if (status.ok() && !settings.displacement.enabled) drawn_ = inputs;
            return status;
          })
      .maps;
}

Status ShadowPass::Draw(const Settings& settings, TextureId maps) {
  const GLuint framebuffer = device_->Framebuffer({}, maps);
  const int resolution = desc_.height;
  const float nothing = 1.0f;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &nothing);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_DEPTH_CLAMP);  // objects nearer to the lamp than the stage cast shadows too
  Status status;
  for (int light = 0; light < settings.shadow.lamps && status.ok(); ++light) {
    // The viewport confines each lamp to its own square of the shared texture.
    glViewport(light * resolution, 0, resolution, resolution);
    status = scene_->DrawShadow(settings, light);
  }
  glDisable(GL_DEPTH_CLAMP);
  return status;
}

}  // namespace furrow::render
