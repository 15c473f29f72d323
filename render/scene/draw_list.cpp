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

// The extent of nothing.
constexpr JointBounds::Extent kNowhere{glm::vec2(2.0f), glm::vec2(-2.0f),
                                       std::numeric_limits<float>::max()};

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
      const float pixels = is_hair ? std::max(tolerance.error_pixels, tolerance.hair_pixels)
                                   : tolerance.error_pixels;
      const int level = gpu->Level(mesh, pixels / look.pixels);
      list.levels.push_back(level);
      const float scale = glm::length(glm::vec3(subjects[subject].subject->placement[0]));
      const int simple = is_hair ? gpu->Level(mesh, tolerance.hair_shadow / scale) : 0;
      list.shadow_levels.push_back(std::max(level, simple));
    }
  }
  has_parts_ = subjects.size() == 1 && tolerance.reach == 0.0f;
  if (has_parts_) FindParts(*gpu, *subjects[0].subject, views, tolerance.all_casters);
}

// A rectangle of a view's picture in normalised device coordinates.
struct DrawList::Rect {
  glm::vec2 low{-1.0f};
  glm::vec2 high{1.0f};

  [[nodiscard]] Rect Grown(float margin) const { return {low - margin, high + margin}; }
};

void DrawList::FindParts(const GpuCharacter& gpu, const PosedSubject& subject, const Views& views,
                         bool all_casters) {
  FindReaches(gpu, subject);
  FindParts(gpu, subject, views, kCamera, Rect{}.Grown(views[kCamera].margin));
  extents_ = Extents(gpu, subject, views[kCamera]);
  for (int lamp = 0; lamp < kNumLights; ++lamp) {
    if (!views[lamp].is_active) continue;
    FindParts(gpu, subject, views, lamp, all_casters ? Rect{} : Shaded(gpu, subject, views[lamp]));
  }
  FindVertices(gpu);
}

// All views need them.
void DrawList::FindReaches(const GpuCharacter& gpu, const PosedSubject& subject) {
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
    if (meshes_[mesh].subjects.empty()) continue;
    const std::span<const MeshCluster> clusters = gpu.meshes()[mesh].clusters;
    meshes_[mesh].reaches.reserve(clusters.size());
    for (const MeshCluster& cluster : clusters) {
      meshes_[mesh].reaches.push_back(cluster.MorphReach(subject.shapes));
    }
  }
}

// Finds the parts that one view sees in `rect`, and forgets the subject where it sees none.
void DrawList::FindParts(const GpuCharacter& gpu, const PosedSubject& subject, const Views& views,
                         int view, const Rect& rect) {
  const ViewSides sides(views[view].projection * subject.placement, subject.model, rect.low,
                        rect.high);
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
    auto& seen = meshes_[mesh].seen[static_cast<std::size_t>(view)];
    if (seen.empty()) continue;
    const std::span<const MeshCluster> clusters = gpu.meshes()[mesh].clusters;
    auto& found = meshes_[mesh].clusters[static_cast<std::size_t>(view)];
    std::vector<ElementRange> indices;
    for (std::uint32_t i = 0; i < clusters.size(); ++i) {
      if (clusters[i].bounds.IsBeyond(sides, meshes_[mesh].reaches[i])) continue;
      found.push_back(i);
      indices.push_back(clusters[i].indices);
    }
    if (found.empty()) seen.clear();
    meshes_[mesh].parts.indices[static_cast<std::size_t>(view)] = Merged(std::move(indices));
  }
}

// Where the parts that the camera sees are in a view: all of them, and those of skin alone.
std::array<JointBounds::Extent, 2> DrawList::Extents(const GpuCharacter& gpu,
                                                     const PosedSubject& subject,
                                                     const View& view) const {
  std::array<JointBounds::Extent, 2> extents{kNowhere, kNowhere};
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
    const GpuMesh& source = gpu.meshes()[mesh];
    const bool is_skin = gpu.material(source.material).kind == character::Material::Kind::kSkin;
    for (const std::uint32_t number : meshes_[mesh].clusters[kCamera]) {
      const JointBounds::Extent extent = source.clusters[number].bounds.Look(
          {subject.model, {}}, view.projection * subject.placement, meshes_[mesh].reaches[number]);
      extents[0] = extents[0].With(extent);
      if (is_skin) extents[1] = extents[1].With(extent);
    }
  }
  return extents;
}

// The part of a lamp's picture whose depths shade what the camera sees.
DrawList::Rect DrawList::Shaded(const GpuCharacter& gpu, const PosedSubject& subject,
                                const View& lamp) const {
  const JointBounds::Extent extent = Extents(gpu, subject, lamp)[0];
  if (extent.nearest <= 0.0f) return {};
  const Rect rect =
      Rect{glm::min(extent.low, glm::vec2(1.0f)), glm::max(extent.high, glm::vec2(-1.0f))}.Grown(
          lamp.margin + lamp.margin_at_1 / extent.nearest);
  return {glm::max(rect.low, glm::vec2(-1.0f)), glm::min(rect.high, glm::vec2(1.0f))};
}

void DrawList::FindVertices(const GpuCharacter& gpu) {
  // Vertices between ranges that lie this close cost less than another range.
  constexpr std::uint32_t kGap = 128;
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
    Mesh& list = meshes_[mesh];
    std::vector<ElementRange> vertices;
    for (int view = 0; view < kNumViews; ++view) {
      if (seen(view, mesh).empty()) continue;
      if (const int level = levels(view, mesh)[0]; level > 0) {
        vertices.push_back(
            {0, gpu.meshes()[mesh].levels[static_cast<std::size_t>(level)].num_vertices});
        continue;
      }
      for (const std::uint32_t number : list.clusters[static_cast<std::size_t>(view)]) {
        const auto& needed = gpu.meshes()[mesh].clusters[number].vertices;
        vertices.insert(vertices.end(), needed.begin(), needed.end());
      }
    }
    list.parts.vertices = Merged(std::move(vertices), kGap);
  }
}

}  // namespace furrow::render
