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
  float front;  // depth in front of the centre
  float back;   // depth behind it
  float x;      // the centre
  float z;
};

// The section at `height`, interpolated smoothly between `sections` and constant beyond both ends.
// Precondition: `sections` are sorted by height, in either direction.
[[nodiscard]] Section SectionAt(std::span<const Section> sections, float height);

// A trunk through `sections`, with rounded ends. `power`: 2 for oval sections, more for squarer
// ones.
[[nodiscard]] float TrunkDistance(const glm::vec3& p, std::span<const Section> sections,
                                  float power);

// The unit gradient, from central differences.
[[nodiscard]] glm::vec3 SolidNormal(const Solid& solid, const glm::vec3& p);

// The surface point near `p`, by Newton steps along the gradient.
[[nodiscard]] glm::vec3 OnSurface(const Solid& solid, const glm::vec3& p);

// The point at which the ray from `from` (inside) along the unit vector `direction` first leaves
// the solid, or the point at distance `reach` if it is still inside there.
[[nodiscard]] glm::vec3 CastOut(const Solid& solid, const glm::vec3& from,
                                const glm::vec3& direction, float reach);

}  // namespace furrow::authoring
