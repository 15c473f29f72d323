// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <glm/vec3.hpp>

namespace furrow::render::test {

// A sphere over the plane y = 0, which reaches to infinity; metres.
struct SphereOnPlane {
  glm::dvec3 centre{0.0};
  double radius = 1.0;
};

// Distance along a ray (unit direction) to the first surface, infinite when there is none.
[[nodiscard]] double RayDistance(const SphereOnPlane& scene, const glm::dvec3& origin,
                                 const glm::dvec3& direction);

// Whether the way from a point of a surface to a distant light (unit direction towards it) is free.
[[nodiscard]] bool SeesLight(const SphereOnPlane& scene, const glm::dvec3& point,
                             const glm::dvec3& normal, const glm::dvec3& to_light);

// ... to a lamp at `lamp`; what stands behind it hides nothing.
[[nodiscard]] bool SeesPoint(const SphereOnPlane& scene, const glm::dvec3& point,
                             const glm::dvec3& normal, const glm::dvec3& lamp);

// Share of the cosine-weighted hemisphere over a point of a surface that is open, by `rays` rays.
// `hides`: how much of a ray a surface takes at a distance in metres, [0, 1].
[[nodiscard]] double Openness(const SphereOnPlane& scene, const glm::dvec3& point,
                              const glm::dvec3& normal, const std::function<double(double)>& hides,
                              int rays);

}  // namespace furrow::render::test
