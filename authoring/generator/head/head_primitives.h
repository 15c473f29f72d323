// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

// The clay that heads are made of: round primitives, added or cut away one after the other.
namespace furrow::authoring {

// One body of half a head (the left side; the other one mirrors it). Head space, centimetres.
struct HeadPrimitive {
  enum class Form { kEllipsoid, kLimb };
  enum class Use { kAdd, kCut };
  const char* name;
  Form form;
  Use use;
  glm::vec3 a;  // ellipsoid: its centre; limb: one end
  glm::vec3 b;  // ellipsoid: its radii; limb: the other end
  glm::vec2 r;  // ellipsoid: turned about y, then about its own x, radians; limb: radii at a and b
  float blend;  // over how many centimetres it flows into what stands before it
};

// A soft dab of clay: raises the surface by `height` at its centre and falls off like a bell.
struct Bulge {
  glm::vec3 centre;
  float width;   // standard deviation
  float height;  // negative: pressed in
};

// A function that is negative inside, positive outside and changes by about 1 a centimetre near the
// surface. `q` with x >= 0.
[[nodiscard]] float PrimitivesDistance(std::span<const HeadPrimitive> primitives,
                                       const glm::vec3& q);
[[nodiscard]] float BulgesHeight(std::span<const Bulge> bulges, const glm::vec3& q);

// The bodies and bulges of an adult head, neither man's nor woman's.
[[nodiscard]] std::span<const HeadPrimitive> AdultPrimitives();
[[nodiscard]] std::span<const Bulge> AdultBulges();

}  // namespace furrow::authoring
