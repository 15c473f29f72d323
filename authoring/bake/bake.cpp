// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/layers/map_baker.h"
#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/request_check.h"
#include "authoring/bake/surface/bake_surface.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

constexpr float kSurface = 0.15f;  // share of a map's time that its surface and strain take

bool Names(const BakeStroke& stroke, const std::string& map) {
  return std::find(stroke.maps.begin(), stroke.maps.end(), map) != stroke.maps.end();
}

// A map that no pose and no stroke feeds is not baked.
bool IsFed(const std::string& map, std::span<const BakePose> poses,
           std::span<const BakeStroke> strokes) {
  return std::any_of(poses.begin(), poses.end(), [&](const auto& p) { return p.map == map; }) ||
         std::any_of(strokes.begin(), strokes.end(), [&](const auto& s) { return Names(s, map); });
}

// The largest difference between the rotations of two poses: 2 sin(angle / 2) of the joint that
// turns most.
float TurnBetween(std::span<const glm::mat4> a, std::span<const glm::mat4> b) {
  float most = 0.0f;
  for (std::size_t j = 0; j < std::min(a.size(), b.size()); ++j) {
    for (int k = 0; k < 3; ++k) {
      most = std::max(most, glm::distance(glm::vec3(a[j][k]), glm::vec3(b[j][k])));
    }
  }
  return most;
}

// The pose of another map of the same region that goes furthest through the end of `pose`; null if
// there is none, or if `pose` itself hardly moves.
const BakePose* PoseBeyond(const BakePose& pose, std::span<const BakePose> poses) {
  constexpr float kStill = 0.2f, kOnTheWay = 0.1f;
  if (pose.path.empty() || TurnBetween(pose.path.front(), pose.path.back()) < kStill)
    return nullptr;
  const BakePose* beyond = nullptr;
  for (const BakePose& other : poses) {
    if (other.region != pose.region || other.map == pose.map) continue;
    if (other.path.size() <= (beyond == nullptr ? pose : *beyond).path.size()) continue;
    const bool passes = std::any_of(other.path.begin(), other.path.end(), [&](const auto& step) {
      return TurnBetween(step, pose.path.back()) < kOnTheWay;
    });
    if (passes) beyond = &other;
  }
  return beyond;
}

}  // namespace

Result<BakedMaps> Bake(const character::Character& character, std::span<const BakePose> poses,
                       std::span<const BakeStroke> strokes, const BakeOptions& options,
                       const std::function<bool(float)>& callback) {
  FURROW_RETURN_IF_ERROR(CheckBake(character, poses, strokes, options));
  std::vector<const wrinkle::WrinkleMap*> fed;
  for (const wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) {
    if (IsFed(map.name, poses, strokes)) fed.push_back(&map);
  }
  BakeProgress progress(callback);
  if (!progress.Report(0.0f)) return BakeProgress::CancelledStatus();
  std::unique_ptr<BakeSurface> surfaces[2];  // skin, cloth
  BakedMaps maps;
  for (const wrinkle::WrinkleMap* map : fed) {
    const float share = 1.0f / static_cast<float>(fed.size());
    const float from = share * static_cast<float>(maps.maps.size());
    const bool last = map == fed.back();
    progress.BeginPart(from, from + kSurface * share);
    const bool cloth = GoesOnCloth(character, *map);
    // Built on first use and shared by all maps of the surface.
    std::unique_ptr<BakeSurface>& surface = surfaces[cloth ? 1 : 0];
    if (surface == nullptr) {
      Result<std::unique_ptr<BakeSurface>> made =
          BakeSurface::Create(character, cloth, options, &progress);
      FURROW_RETURN_IF_ERROR(made);
      surface = std::move(made).value();
    }
    MapBaker baker(character, *surface, options, map->name, cloth);
    for (const BakePose& pose : poses) {
      if (pose.map != map->name) continue;
      baker.AddPose(pose, cloth ? PoseBeyond(pose, poses) : nullptr);
      if (!progress.Report(1.0f)) return BakeProgress::CancelledStatus();
    }
    for (const BakeStroke& stroke : strokes) {
      if (Names(stroke, map->name)) baker.AddStroke(stroke);
    }
    auto baked = baker.Bake(from + kSurface * share, last ? 1.0f : from + share, &progress);
    FURROW_RETURN_IF_ERROR(baked);
    maps.maps.push_back(std::move(**baked));
  }
  return maps;
}

}  // namespace furrow::authoring
