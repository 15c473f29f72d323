// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include <glm/vec3.hpp>

// Implicit solids: functions of a point that are negative inside and positive outside, with a
// gradient of about 1 near the surface. Metres throughout.
namespace furrow::authoring {

using Solid = std::function<float(const glm::vec3&)>;

// The distance to the union of two solids with distances `a` and `b`, with a fillet about `radius`
// wide.
[[nodiscard]] float SmoothMin(float a, float b, float radius);

// The distance to a rod from `a` to `b` with the radii `radius_a` and `radius_b` at its ends.
[[nodiscard]] float RodDistance(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                                float radius_a, float radius_b);

// One cross-section of an upright trunk or leg: an oval with different depths in front and behind.
struct Section {
  float height;  // y
  float half_width;
  float front;  // depth in front of the centre
  float back;   // depth behind it
  float x;      // x of the centre
  float z;      // z of the centre
};

// The section at `height`, interpolated smoothly between `sections` and constant beyond both ends.
// Precondition: `sections` are sorted by height, in either direction.
[[nodiscard]] Section SectionAt(std::span<const Section> sections, float height);

// The distance to a trunk through `sections`, with rounded ends. `power`: exponent of the outline
// of a section, 2 for an oval, more for a squarer shape.
[[nodiscard]] float TrunkDistance(const glm::vec3& p, std::span<const Section> sections,
                                  float power);

// The unit gradient of `solid` at `p`, from central differences. It points outward.
[[nodiscard]] glm::vec3 SolidNormal(const Solid& solid, const glm::vec3& p);

// The surface point near `p`, from Newton steps along the gradient. Precondition: `p` is near the
// surface.
[[nodiscard]] glm::vec3 OnSurface(const Solid& solid, const glm::vec3& p);

// The point at which the ray from `from` (inside) along the unit vector `direction` first leaves
// the solid, or the point at distance `reach` if it is still inside there.
[[nodiscard]] glm::vec3 CastOut(const Solid& solid, const glm::vec3& from,
                                const glm::vec3& direction, float reach);

}  // namespace furrow::authoring
