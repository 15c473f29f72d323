// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/painted_mask.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "base/scalar.h"
#include "render/wrinkles/uv_raster.h"
#include "render/wrinkles/wrinkle_table.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/weights/sliding_mask.h"
#include "wrinkle/weights/vertex_influence.h"

namespace furrow::authoring {
namespace {

using render::WrinkleGroup;

constexpr float kReach = 2.5f;  // texels beyond the surface that filtering may sample
// Points inside their triangles that share a texel: how far their masks may differ, the barycentric
// distance from an edge, beyond which a texel may belong to the neighbour, and the number of specks
// that are allowed.
constexpr float kMaxDifference = 2.0f / 255.0f;
constexpr float kEdge = 1e-3f;
constexpr int kMaxShared = 16;

// True if one of the region's maps is drawn on the material.
bool IsOn(const character::Character& character, const wrinkle::Region& region,
          const character::Material& material) {
  const WrinkleGroup group = render::GroupOf(character, material);
  return std::ranges::any_of(region.feeds, [&](const wrinkle::Feed& feed) {
    const auto map =
        std::ranges::find(character.rig.wrinkle_maps, feed.map, &wrinkle::WrinkleMap::name);
    return map != character.rig.wrinkle_maps.end() && render::IsDrawnOn(character, *map, group);
  });
}

// The mask at a vertex, not yet clamped, so that it stays a sum within a triangle.
using MaskOfVertex = std::function<float(const character::Vertex&)>;

float SkinnedMaskAt(const character::Vertex& vertex, const std::vector<int>& joints,
                    const wrinkle::Mask& mask) {
  float sum = 0.0f;
  for (int i = 0; i < 4; ++i) {
    if (!std::ranges::binary_search(joints, int{vertex.joints[i]})) continue;
    sum += wrinkle::Lambda(mask.lambda, vertex.skin_weights[i], mask.smooth_width);
  }
  return sum;
}

// Where a sliding mask lies.
struct SlidingPlace {
  wrinkle::SlidingFrame frame;
  glm::vec3 towards{0.0f};
};

// The place of the mask of one feed; nothing if it moves, or if a joint is missing. The mask is
// drawn only while the value that it follows is above 0, so another value must not raise the
// weight.
std::optional<SlidingPlace> PlaceOf(const wrinkle::Driver& driver, const wrinkle::Feed& feed,
                                    const wrinkle::Skeleton& skeleton) {
  const auto frame = wrinkle::RestSlidingFrame(driver, feed, skeleton);
  if (!frame || feed.sources.empty()) return std::nullopt;
  const std::vector<std::string> names = wrinkle::DriverValueNames(driver);
  const std::string& followed = feed.sources.front().value;
  const bool is_one = std::ranges::all_of(feed.sources, [&](const wrinkle::Feed::Source& source) {
    return source.driver == driver.name && source.value == followed;
  });
  const auto index = std::ranges::find(names, followed) - names.begin();
  if (!is_one || driver.kind == wrinkle::Driver::Kind::kBall ||
      std::ranges::find(frame->values, static_cast<int>(index)) == frame->values.end()) {
    return std::nullopt;
  }
  std::vector<float> values(names.size(), 0.0f);
  values[static_cast<std::size_t>(index)] = 1.0f;
  return SlidingPlace{*frame, wrinkle::BendDirection(*frame, values)};
}

// The place that all feeds of a region share; nothing if there is none.
std::optional<SlidingPlace> PlaceOf(const character::Character& character,
                                    const wrinkle::Region& region) {
  const auto driver =
      std::ranges::find(character.rig.drivers, region.mask.driver, &wrinkle::Driver::name);
  if (driver == character.rig.drivers.end()) return std::nullopt;
  std::optional<SlidingPlace> shared;
  for (const wrinkle::Feed& feed : region.feeds) {
    const auto place = PlaceOf(*driver, feed, character.skeleton);
    if (!place || (shared && shared->towards != place->towards)) return std::nullopt;
    shared = place;
  }
  return shared;
}

// A mask under construction: the value of the nearest point of the surface for each texel.
struct Canvas {
  explicit Canvas(int texels)
      : side(texels),
        values(static_cast<std::size_t>(texels) * static_cast<std::size_t>(texels), 0.0f),
        distances(values.size(), std::numeric_limits<float>::max()) {}

  void Paint(const character::Mesh& mesh, const MaskOfVertex& mask) {
    std::vector<render::UvTriangle> triangles;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto uv = [&](std::size_t c) { return mesh.vertices[mesh.indices[i + c]].uv; };
      triangles.push_back({uv(0), uv(1), uv(2)});
    }
    if (!render::IsAtlas(triangles)) return;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto at = [&](std::size_t c) { return mask(mesh.vertices[mesh.indices[3 * t + c]]); };
      const glm::vec3 corners(at(0), at(1), at(2));
      render::ForTexels(triangles[t], glm::ivec2(side), kReach, [&](const render::UvTexel& texel) {
        Add(texel, glm::dot(texel.shares, corners));
      });
    }
  }

  void Add(const render::UvTexel& texel, float value) {
    float& distance = distances[texel.index];
    float& stored = values[texel.index];
    if (texel.distance_squared > distance) return;
    const bool is_shared = distance == 0.0f;
    if (is_shared && std::min({texel.shares.x, texel.shares.y, texel.shares.z}) > kEdge &&
        std::abs(Saturate(value) - Saturate(stored)) > kMaxDifference) {
      ++shared;
    }
    stored = is_shared ? std::max(stored, value) : value;
    distance = texel.distance_squared;
  }

  int side;
  std::vector<float> values;
  std::vector<float> distances;  // squared, in texels
  int shared = 0;                // visits to a texel with another mask
};

}  // namespace

std::vector<int> MaskJoints(const character::Character& character, const wrinkle::Region& region) {
  std::set<int> joints;
  for (const wrinkle::Feed& feed : region.feeds) {
    for (const wrinkle::Feed::Source& source : feed.sources) {
      const auto driver =
          std::ranges::find(character.rig.drivers, source.driver, &wrinkle::Driver::name);
      if (driver == character.rig.drivers.end()) continue;
      const std::vector<std::string> names = wrinkle::VisitFields(
          *driver, [](const auto& fields) { return JointsInfluenced(fields); });
      for (const std::string& name : names) joints.insert(character.skeleton.Find(name));
    }
  }
  joints.erase(wrinkle::kNoJoint);
  return {joints.begin(), joints.end()};
}

bool CanPaintMask(const character::Character& character, const wrinkle::Region& region) {
  switch (region.mask.kind) {
    case wrinkle::Mask::Kind::kTexture: return false;
    case wrinkle::Mask::Kind::kSkinning: return !MaskJoints(character, region).empty();
    case wrinkle::Mask::Kind::kSliding: return PlaceOf(character, region).has_value();
  }
  return false;
}

PaintedMask PaintMask(const character::Character& character, const wrinkle::Region& region,
                      int side) {
  const std::vector<int> joints = MaskJoints(character, region);
  const bool slides = region.mask.kind == wrinkle::Mask::Kind::kSliding;
  const SlidingPlace place =
      slides ? PlaceOf(character, region).value_or(SlidingPlace{}) : SlidingPlace{};
  const MaskOfVertex mask_at = [&](const character::Vertex& vertex) {
    return slides ? wrinkle::SlidingMaskAt(place.frame, region.mask, place.towards, vertex.position)
                  : SkinnedMaskAt(vertex, joints, region.mask);
  };
  Canvas canvas(side);
  for (const character::Mesh& mesh : character.meshes) {
    if (mesh.material < 0) continue;
    if (IsOn(character, region, character.materials[static_cast<std::size_t>(mesh.material)])) {
      canvas.Paint(mesh, mask_at);
    }
  }
  PaintedMask mask;
  mask.is_shared = canvas.shared > kMaxShared;
  character::Picture& picture = mask.picture;
  picture.name = region.name;
  picture.width = picture.height = side;
  picture.channels = 1;
  picture.pixels.reserve(canvas.values.size());
  for (const float value : canvas.values) {
    picture.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * Saturate(value))));
  }
  return mask;
}

}  // namespace furrow::authoring
