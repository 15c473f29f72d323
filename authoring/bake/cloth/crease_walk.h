// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// Where and how cloth has length to hide. One entry per vertex of a mesh.
struct CreaseField {
  std::vector<glm::vec3> along;  // unit vector along which creases run, of either sign
  std::vector<float> excess;     // share of the length across the creases that they hide, [0, 1)
  std::vector<float> spacing;    // from crease to crease, metres, > 0
  std::vector<float> tilt;       // how far noise turns a crease, radians
};

// Walks over a mesh along a field of creases.
class CreaseWalk {
 public:
  // A place in a triangle, and the way on from it.
  struct Spot {
    std::uint32_t triangle = 0;
    glm::vec3 corners{1.0f, 0.0f, 0.0f};  // barycentric
    glm::vec3 direction{0.0f};            // unit vector
  };

  // `mesh` and `field` must outlive the walk. `seed`: of the noise that turns the field.
  CreaseWalk(const FineMesh& mesh, const CreaseField& field, std::uint32_t seed);

  // Beside a vertex, along the field; nothing if no triangle there has an area.
  [[nodiscard]] std::optional<Spot> StartAt(std::uint32_t vertex) const;
  // Turns the spot along the field and takes it through its triangle to the next. `walked` becomes
  // the length of this step, metres. Returns false where it cannot go on: at a border, and in a
  // triangle without area. The spot then stays in its triangle.
  [[nodiscard]] bool Step(Spot* spot, float* walked) const;

  // A value per vertex at a spot.
  template <class T>
  [[nodiscard]] T At(std::span<const T> values, const Spot& spot) const {
    const auto& v = mesh_.triangles()[spot.triangle].vertices;
    return values[v[0]] * spot.corners.x + values[v[1]] * spot.corners.y +
           values[v[2]] * spot.corners.z;
  }
  [[nodiscard]] glm::vec3 PlaceOf(const Spot& spot) const { return At(mesh_.positions(), spot); }

 private:
  [[nodiscard]] glm::vec3 AreaOf(std::uint32_t triangle) const;
  [[nodiscard]] glm::vec3 DirectionAt(const Spot& spot, const glm::vec3& normal) const;

  const FineMesh& mesh_;
  const CreaseField& field_;
  std::uint32_t seed_;
  // Per triangle: those across its edges, or none.
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<std::uint32_t> first_triangle_;  // per vertex, or none
};

}  // namespace furrow::authoring
