// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include <glm/vec3.hpp>

// Implicit solids: functions of a point that are negative inside and positive outside, with a
// gradient of about 1 near the surface. Metres throughout.
namespace furrow::authoring {

using Solid = std::function<float(const glm::vec3&)>;

// The union of two solids with a fillet about `radius` wide.
[[nodiscard]] float SmoothMin(float a, float b, float radius);

// A rod from `a` to `b` with a radius at each end.
[[nodiscard]] float RodDistance(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                                float radius_a, float radius_b);

// One cross-section of an upright trunk or leg: an oval with different depths in front and behind.
struct Section {
  float height;  // y
  float half_width;
  float front;  // depth from the middle to the front; `back` likewise
  float back;
  float x;  // the middle
  float z;
};

// The section at a height, interpolated smoothly. `sections`: sorted by height, rising or falling.
// Constant beyond both ends.
[[nodiscard]] Section SectionAt(std::span<const Section> sections, float height);

// A solid of sections with rounded ends. `power`: 2 for ovals, more for squarer shapes.
[[nodiscard]] float TrunkDistance(const glm::vec3& p, std::span<const Section> sections,
                                  float power);

// The unit gradient by differences.
[[nodiscard]] glm::vec3 SolidNormal(const Solid& solid, const glm::vec3& p);

// The surface point near `p`, by Newton steps along the gradient.
[[nodiscard]] glm::vec3 OnSurface(const Solid& solid, const glm::vec3& p);

// The point at which the ray from `from` (inside) along the unit vector `direction` first leaves
// the solid, at most `reach` away.
[[nodiscard]] glm::vec3 CastOut(const Solid& solid, const glm::vec3& from,
                                const glm::vec3& direction, float reach);

}  // namespace furrow::authoring
