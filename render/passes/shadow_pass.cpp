// SPDX-License-Identifier: Apache-2.0
#include "render/passes/shadow_pass.h"

#include <utility>

#include "render/mesh/mesh_morphs.h"
#include "render/request/subjects.h"

namespace furrow::render {
namespace {

// Larger maps are drawn for every picture, because each stream keeps its own.
constexpr std::size_t kMaxStreamBytes = std::size_t{8} << 20;

void Append(const glm::mat4& matrix, std::vector<float>* values) {
  values->insert(values->end(), &matrix[0].x, &matrix[0].x + 16);
}

}  // namespace

ShadowPass::~ShadowPass() { maps_.Release(device_); }

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
    scene_->AppendCasters(static_cast<int>(light), &values);
  }
  for (const NamedSubject& named : SubjectsOf(request)) {
    Append(named.subject->placement, &values);
    for (const glm::mat4& joint : named.subject->model) Append(joint, &values);
    for (const float shape : named.subject->shapes) values.push_back(DrawnShapeWeight(shape));
  }
  return values;
}

TextureDesc ShadowPass::Wanted() const {
  const int resolution = scene_->setup().shadow_resolution;
  return {resolution * kNumLights, resolution, PixelFormat::kDepth32F, 1};
}

FrameGraph::Handle ShadowPass::AddDrawing(FrameGraph* graph, FrameGraph::Handle maps,
                                          const Settings& settings,
                                          std::function<void(bool)> finished) {
  struct Data {
    FrameGraph::Handle maps;
  };
  return graph
      ->AddPass<Data>(
          "shadows",
          [&](FrameGraph::Builder& builder, Data& pass) { pass.maps = builder.Write(maps); },
          [this, settings, finished = std::move(finished)](const FrameGraph::Resources& resources,
                                                           const Data& pass) {
            Status status = Draw(settings, resources.Get(pass.maps));
            finished(status.ok());
            return status;
          })
      .maps;
}

FrameGraph::Handle ShadowPass::AddForStream(FrameGraph* graph, const Settings& settings,
                                            KeptShadows* kept, bool keeps) {
  if (!keeps) {
    kept->maps.Prepare(Wanted(), device_);
    kept->is_drawn = false;
  }
  const FrameGraph::Handle maps = graph->Import("shadow maps", kept->maps.desc, kept->maps.texture);
  if (keeps) return maps;
  return AddDrawing(graph, maps, settings, [kept](bool is_drawn) { kept->is_drawn = is_drawn; });
}

FrameGraph::Handle ShadowPass::Add(FrameGraph* graph, const FrameRequest& request,
                                   KeptShadows* kept) {
  if (kept != nullptr) {
    const bool keeps = scene_->shadow_camera() != nullptr;
    if (keeps || TextureBytes(Wanted()) <= kMaxStreamBytes) {
      return AddForStream(graph, request.settings, kept, keeps);
    }
    kept->is_drawn = false;  // the next picture must not use older ones
  }
  if (maps_.Prepare(Wanted(), device_)) drawn_.clear();
  // Imported, because the maps outlive the frame. The pool would hand a transient texture to other
  // passes.
  const FrameGraph::Handle maps = graph->Import("shadow maps", maps_.desc, maps_.texture);
  std::vector<float> inputs = Inputs(request);
  // The subdivision of displaced patches depends on the camera, and their position on wrinkle
  // weights.
  const bool is_displaced = request.settings.displacement.enabled;
  if (inputs == drawn_ && !is_displaced) return maps;
  // Cleared first, so that a failed pass does not leave outdated maps marked as current. Recorded
  // only when the pass has run: the graph may cull it.
  drawn_.clear();
  return AddDrawing(graph, maps, request.settings,
                    [this, is_displaced, inputs = std::move(inputs)](bool is_drawn) {
                      if (is_drawn && !is_displaced) drawn_ = inputs;
                    });
}

Status ShadowPass::Draw(const Settings& settings, TextureId maps) {
  const GLuint framebuffer = device_->Framebuffer({}, maps);
  const int resolution = scene_->setup().shadow_resolution;
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
