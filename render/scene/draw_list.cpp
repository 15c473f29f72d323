// SPDX-License-Identifier: Apache-2.0
#include "render/scene/draw_list.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

// One subject's mesh as the views see it.
struct Look {
  std::array<bool, DrawList::kNumViews> is_seen{};
  float pixels = 0.0f;   // pixels per metre of the mesh at its nearest point
  float covered = 0.0f;  // upper bound of the covered share of the camera's picture
};

// The share of the picture that an extent covers.
float Covered(const JointBounds::Extent& extent) {
  if (extent.nearest <= 0.0f) return 1.0f;
  const glm::vec2 size = glm::min(extent.high, glm::vec2(1.0f)) -  //
                         glm::max(extent.low, glm::vec2(-1.0f));
  return 0.25f * size.x * size.y;
}

// Projects the mesh's bounds into all views. The level of detail follows from the camera, or, for a
// subject that only casts shadows into the picture, from the lamp that sees it largest.
Look LookAt(const JointBounds& bounds, const PosedSubject& subject,
            std::span<const DrawList::View> views, float reach) {
  Look look;
  float of_lamps = 0.0f;
  for (std::size_t view = 0; view < views.size(); ++view) {
    if (!views[view].is_active) continue;
    const auto extent = bounds.Look({subject.model, subject.shapes},
                                    views[view].projection * subject.placement, reach);
    if (!extent.is_seen()) continue;
    look.is_seen[view] = true;
    const float pixels = extent.nearest > 0.0f ? views[view].pixels / extent.nearest
                                               : std::numeric_limits<float>::infinity();
    float& most = view == DrawList::kCamera ? look.pixels : of_lamps;
    most = std::max(most, pixels);
    if (view == DrawList::kCamera) look.covered = Covered(extent);
  }
  if (!look.is_seen[DrawList::kCamera]) look.pixels = of_lamps;
  look.pixels *= glm::length(glm::vec3(subject.placement[0]));
  return look;
}

}  // namespace

void DrawList::Build(GpuCharacter* gpu, std::span<const NamedSubject> subjects,
                     const std::array<View, kNumViews>& views, const Tolerance& tolerance) {
  meshes_.assign(gpu->meshes().size(), {});
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
    Mesh& list = meshes_[mesh];
    const bool is_hair = gpu->material(gpu->meshes()[mesh].material).kind ==  //
                         character::Material::Kind::kHair;
    for (std::size_t subject = 0; subject < subjects.size(); ++subject) {
      const Look look =
          LookAt(gpu->meshes()[mesh].bounds, *subjects[subject].subject, views, tolerance.reach);
      if (std::ranges::none_of(look.is_seen, std::identity())) continue;
      for (std::size_t view = 0; view < views.size(); ++view) {
        if (!look.is_seen[view]) continue;
        list.seen[view].push_back(static_cast<std::uint32_t>(list.subjects.size()));
      }
      if (look.is_seen[kCamera]) {
        list.sight.pixels = std::max(list.sight.pixels, look.pixels);
        list.sight.covered += look.covered;
      }
      list.subjects.push_back(static_cast<std::uint32_t>(subject));
      // Allowed error in metres. An infinite number of pixels (a box reaches behind the camera)
      // allows none.
      const int level = gpu->Level(mesh, tolerance.error_pixels / look.pixels);
      list.levels.push_back(level);
      const float scale = glm::length(glm::vec3(subjects[subject].subject->placement[0]));
      const int simple = is_hair ? gpu->Level(mesh, tolerance.hair_shadow / scale) : 0;
      list.shadow_levels.push_back(std::max(level, simple));
    }
  }
}

}  // namespace furrow::render
