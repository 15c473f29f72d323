// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/render/reference/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace furrow::render::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLift = 1e-7;  // metres; prevents self-intersection

double SphereDistance(const SphereOnPlane& scene, const glm::dvec3& origin,
                      const glm::dvec3& direction) {
  const glm::dvec3 to_centre = scene.centre - origin;
  const double along = glm::dot(to_centre, direction);
  const double inside =
      scene.radius * scene.radius - (glm::dot(to_centre, to_centre) - along * along);
  if (inside < 0.0) return kInfinity;
  const double near = along - std::sqrt(inside);
  return near > 0.0 ? near : kInfinity;
}

double PlaneDistance(const glm::dvec3& origin, const glm::dvec3& direction) {
  if (direction.y >= 0.0) return kInfinity;
  const double distance = -origin.y / direction.y;
  return distance > 0.0 ? distance : kInfinity;
}

}  // namespace

double RayDistance(const SphereOnPlane& scene, const glm::dvec3& origin,
                   const glm::dvec3& direction) {
  return std::min(SphereDistance(scene, origin, direction), PlaneDistance(origin, direction));
}

bool SeesLight(const SphereOnPlane& scene, const glm::dvec3& point, const glm::dvec3& normal,
               const glm::dvec3& to_light) {
  if (glm::dot(normal, to_light) <= 0.0) return false;
  return RayDistance(scene, point + kLift * normal, to_light) == kInfinity;
}

bool SeesPoint(const SphereOnPlane& scene, const glm::dvec3& point, const glm::dvec3& normal,
               const glm::dvec3& lamp) {
  const glm::dvec3 way = lamp - point;
  if (glm::dot(normal, way) <= 0.0) return false;
  return RayDistance(scene, point + kLift * normal, glm::normalize(way)) >= glm::length(way);
}

double Openness(const SphereOnPlane& scene, const glm::dvec3& point, const glm::dvec3& normal,
                const std::function<double(double)>& hides, int rays) {
  const glm::dvec3 side = std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(side, normal));
  const glm::dvec3 bitangent = glm::cross(normal, tangent);
  const double golden_angle = glm::pi<double>() * (3.0 - std::sqrt(5.0));
  double open = 0.0;
  for (int i = 0; i < rays; ++i) {
    // Evenly distributed points of the unit disc, lifted to the hemisphere: cosine-weighted
    // (Malley).
    const double share = (i + 0.5) / rays;
    const double radius = std::sqrt(share);
    const glm::dvec3 direction = radius * std::cos(golden_angle * i) * tangent +
                                 radius * std::sin(golden_angle * i) * bitangent +
                                 std::sqrt(1.0 - share) * normal;
    const double distance = RayDistance(scene, point + kLift * normal, direction);
    open += std::isfinite(distance) ? 1.0 - hides(distance) : 1.0;
  }
  return open / rays;
}

}  // namespace furrow::render::test
