// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include <glm/vec3.hpp>

// Implicit solids: functions of a point that are negative inside, positive outside, and change by
// about 1 a metre near their surface. Metres throughout.
namespace furrow::authoring {

using Solid = std::function<float(const glm::vec3&)>;

// The union of two solids with a fillet about `radius` wide where they meet.
[[nodiscard]] float SmoothMin(float a, float b, float radius);

// A rod from `a` to `b` with a radius at either end.
[[nodiscard]] float RodDistance(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                                float radius_a, float radius_b);

// One section of an upright trunk or leg: an oval, flatter before than behind or the other way.
struct Section {
  float height;  // y
  float half_width;
  float front;  // depth from the middle to the front, and to the back
  float back;
  float x;  // the middle
  float z;
};

// The section at a height, smoothly between those given (by falling or rising height); the first
// and the last one beyond them.
[[nodiscard]] Section SectionAt(std::span<const Section> sections, float height);

// A solid of sections; `power` 2 makes ovals, more makes them squarer. Its ends are rounded off.
[[nodiscard]] float TrunkDistance(const glm::vec3& p, std::span<const Section> sections,
                                  float power);

// Unit gradient by differences.
[[nodiscard]] glm::vec3 SolidNormal(const Solid& solid, const glm::vec3& p);

// The surface near `p`: Newton's steps along the gradient.
[[nodiscard]] glm::vec3 OnSurface(const Solid& solid, const glm::vec3& p);

// Where the ray from `from` (inside) along unit `direction` first leaves the solid; at most `reach`
// away.
[[nodiscard]] glm::vec3 CastOut(const Solid& solid, const glm::vec3& from,
                                const glm::vec3& direction, float reach);

}  // namespace furrow::authoring
