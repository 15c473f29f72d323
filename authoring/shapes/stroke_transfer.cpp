// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/stroke_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <glm/geometric.hpp>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// The vertical axis of a head lies behind its eyes by this many eye distances: 83 mm of 64.
constexpr float kAxisBehindEyes = 1.3f;
// Skin farther from the axis is not the face: a collar, or an ear seen from the front.
constexpr float kFarthestSkin = 2.2f;  // eye distances
constexpr float kBelowChin = 0.3f;     // eye distances

float AxisDepth(const FaceMeasures& face) {
  return face.eye_depth - kAxisBehindEyes * face.eye_distance;
}

// The direction of a corner of the mouth, seen from the axis.
float MouthAngle(const FaceMeasures& face) {
  return std::atan2(face.corner_x,
                    std::max(face.corner_z - AxisDepth(face), 0.5f * face.eye_distance));
}

// Maps a height by the heights that both faces have, and beyond them by their mean scale.
float HeightOn(const FaceMeasures& from, const FaceMeasures& to, float y) {
  const std::array a = {from.chin, from.corner, from.lid, from.brow};
  const std::array b = {to.chin, to.corner, to.lid, to.brow};
  const float scale = (to.brow - to.corner) / (from.brow - from.corner);
  if (y <= a.front()) return b.front() + scale * (y - a.front());
  if (y >= a.back()) return b.back() + scale * (y - a.back());
  std::size_t i = 0;
  while (y > a[i + 1]) ++i;
  return b[i] + (b[i + 1] - b[i]) * (y - a[i]) / (a[i + 1] - a[i]);
}

// The distance along a ray at which it meets a triangle (Moeller and Trumbore 1997).
std::optional<float> Meet(const vec3& origin, const vec3& ray, const vec3& a, const vec3& b,
                          const vec3& c) {
  const vec3 ab = b - a, ac = c - a, across = glm::cross(ray, ac);
  const float determinant = glm::dot(ab, across);
  if (std::abs(determinant) < 1e-14f) return std::nullopt;
  const vec3 offset = origin - a;
  const float u = glm::dot(offset, across) / determinant;
  const vec3 other = glm::cross(offset, ab);
  const float v = glm::dot(ray, other) / determinant;
  if (u < 0.0f || v < 0.0f || u + v > 1.0f) return std::nullopt;
  const float distance = glm::dot(ac, other) / determinant;
  return distance > 0.0f ? std::optional(distance) : std::nullopt;
}

class Transfer {
 public:
  Transfer(const FaceMeasures& from, const FaceMeasures& to, const FaceSkin& skin)
      : from_(from), to_(to), skin_(skin), triangles_(skin.Triangles()) {
    mouth_turn_ = std::clamp(MouthAngle(to) / MouthAngle(from), 0.6f, 1.6f);
    scale_ = 0.5f * (to.eye_distance / from.eye_distance +
                     (to.brow - to.corner) / (from.brow - from.corner));
  }

  [[nodiscard]] float scale() const { return scale_; }

  // Nothing if no skin lies there.
  [[nodiscard]] std::optional<vec3> Place(const vec3& point) const {
    const float y = HeightOn(from_, to_, point.y);
    // Between lids and mouth, the turn follows the height.
    const float down = Smoothstep(0.0f, 1.0f, (from_.lid - point.y) / (from_.lid - from_.corner));
    const float angle = std::atan2(point.x - from_.middle, point.z - AxisDepth(from_)) *
                        (1.0f + down * (mouth_turn_ - 1.0f));
    const vec3 origin(to_.middle, y, AxisDepth(to_));
    const vec3 ray(std::sin(angle), 0.0f, std::cos(angle));
    const float limit = kFarthestSkin * to_.eye_distance;
    float farthest = 0.0f;
    for (const auto& [a, b, c] : triangles_) {
      const auto distance =
          Meet(origin, ray, skin_.positions()[a], skin_.positions()[b], skin_.positions()[c]);
      if (distance && *distance < limit) farthest = std::max(farthest, *distance);
    }
    if (farthest <= 0.0f) return std::nullopt;
    return origin + farthest * ray;
  }

 private:
  const FaceMeasures& from_;
  const FaceMeasures& to_;
  const FaceSkin& skin_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  float mouth_turn_ = 1.0f;
  float scale_ = 1.0f;
};

template <class Item>
bool IsNameOf(const std::vector<Item>& items, const std::string& name) {
  return std::any_of(items.begin(), items.end(),
                     [&](const Item& item) { return item.name == name; });
}

}  // namespace

const FaceMeasures& DefaultFaceMeasures() {
  static const FaceMeasures kFace{.middle = 0.0f,
                                  .eye_distance = 0.0627f,
                                  .eye_depth = 0.0979f,
                                  .brow = 1.6620f,
                                  .lid = 1.6410f,
                                  .wing = 1.5906f,
                                  .corner = 1.5654f,
                                  .chin = 1.5278f,
                                  .wing_x = 0.0188f,
                                  .corner_x = 0.0253f,
                                  .corner_z = 0.0972f};
  return kFace;
}

std::vector<BakeStroke> FirmCheeks() {
  struct Line {
    const char* name;
    float width_mm;
    std::vector<vec3> points;  // of the left side
  };
  const Line lines[] = {{"firm_cheek",
                         34.0f,
                         {{0.036f, 1.611f, 0.090f},
                          {0.048f, 1.596f, 0.082f},
                          {0.052f, 1.573f, 0.075f},
                          {0.047f, 1.548f, 0.072f}}},
                        {"firm_mouth",
                         22.0f,
                         {{0.026f, 1.598f, 0.098f},
                          {0.034f, 1.580f, 0.094f},
                          {0.036f, 1.563f, 0.090f},
                          {0.031f, 1.548f, 0.090f}}}};
  std::vector<BakeStroke> strokes;
  for (const Line& line : lines) {
    for (const bool left : {true, false}) {
      BakeStroke& stroke = strokes.emplace_back();
      stroke.name = std::string(line.name) + (left ? "_l" : "_r");
      stroke.kind = BakeStroke::Kind::kExclude;
      stroke.maps = {"squash", "stretch"};
      stroke.width_mm = line.width_mm;
      for (const vec3& p : line.points) stroke.points.push_back({left ? p.x : -p.x, p.y, p.z});
    }
  }
  return strokes;
}

TransferredStrokes TransferStrokes(std::span<const BakeStroke> strokes, const FaceMeasures& from,
                                   const FaceMeasures& to, const FaceSkin& skin,
                                   const wrinkle::Rig& rig) {
  const Transfer transfer(from, to, skin);
  const float lowest = from.chin - kBelowChin * from.eye_distance;
  TransferredStrokes moved;
  for (const BakeStroke& stroke : strokes) {
    if (stroke.personal) continue;
    BakeStroke copy = stroke;
    std::erase_if(copy.maps, [&](const auto& map) { return !IsNameOf(rig.wrinkle_maps, map); });
    if (copy.maps.empty()) continue;
    if (!copy.region.empty() && !IsNameOf(rig.regions, copy.region)) continue;
    if (std::all_of(copy.points.begin(), copy.points.end(),
                    [&](const vec3& p) { return p.y < lowest; })) {
      continue;
    }
    copy.points.clear();
    for (const vec3& point : stroke.points) {
      if (const auto place = transfer.Place(point)) copy.points.push_back(*place);
    }
    if (copy.points.size() < 2) {
      ++moved.lost;
      continue;
    }
    copy.width_mm *= transfer.scale();
    copy.depth_mm *= transfer.scale();
    copy.wavelength_mm *= transfer.scale();
    moved.strokes.push_back(std::move(copy));
  }
  return moved;
}

}  // namespace furrow::authoring
