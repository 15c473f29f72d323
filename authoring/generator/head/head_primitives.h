// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

// The shape of a head as rounded primitives, which are added or cut away one after the other.
namespace furrow::authoring {

// One primitive of half a head. It describes the left side; the right side mirrors it. Head space,
// centimetres.
struct HeadPrimitive {
  enum class Form { kEllipsoid, kLimb };  // kLimb: a rod with a radius at each end
  enum class Use { kAdd, kCut };
  const char* name;
  Form form;
  Use use;
  glm::vec3 a;  // ellipsoid: its centre; limb: one end
  glm::vec3 b;  // ellipsoid: its radii; limb: the other end
  // Ellipsoid: angles of the rotations about y and then about the rotated x, radians. Limb: the
  // radii at a and b.
  glm::vec2 r;
  float blend;  // width of the blend into the preceding primitives, centimetres
};

// A soft bulge that raises the surface, with a Gaussian profile. Head space, centimetres.
struct Bulge {
  glm::vec3 centre;
  float width;   // standard deviation
  float height;  // at the centre; negative: a dent
};

// The signed distance from `q` to the primitives, centimetres: negative inside, with a gradient of
// about 1 near the surface. `q`: head space, q.x >= 0.
[[nodiscard]] float PrimitivesDistance(std::span<const HeadPrimitive> primitives,
                                       const glm::vec3& q);
// The height by which all bulges together raise the surface at `q`, centimetres. q.x >= 0.
[[nodiscard]] float BulgesHeight(std::span<const Bulge> bulges, const glm::vec3& q);

// The primitives and bulges of an adult head that is neither male nor female.
[[nodiscard]] std::span<const HeadPrimitive> AdultPrimitives();
[[nodiscard]] std::span<const Bulge> AdultBulges();

}  // namespace furrow::authoring
