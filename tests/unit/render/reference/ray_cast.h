// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <glm/vec3.hpp>

namespace furrow::render::test {

// A sphere over the infinite plane y = 0; metres.
struct SphereOnPlane {
  glm::dvec3 centre{0.0};
  double radius = 1.0;
};

// Distance along a ray (unit direction) to the first surface; infinite if there is none.
[[nodiscard]] double RayDistance(const SphereOnPlane& scene, const glm::dvec3& origin,
                                 const glm::dvec3& direction);

// Returns true if the path from a surface point to a distant light (unit direction towards it) is
// free.
[[nodiscard]] bool SeesLight(const SphereOnPlane& scene, const glm::dvec3& point,
                             const glm::dvec3& normal, const glm::dvec3& to_light);

// The same for a lamp at `lamp`. Surfaces behind the lamp do not block it.
[[nodiscard]] bool SeesPoint(const SphereOnPlane& scene, const glm::dvec3& point,
                             const glm::dvec3& normal, const glm::dvec3& lamp);

// Open share of the cosine-weighted hemisphere above a surface point, estimated with `rays` rays.
// `hides`: share of a ray that a surface at a distance in metres blocks, [0, 1].
[[nodiscard]] double Openness(const SphereOnPlane& scene, const glm::dvec3& point,
                              const glm::dvec3& normal, const std::function<double(double)>& hides,
                              int rays);

}  // namespace furrow::render::test
