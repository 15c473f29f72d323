// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::character::bake {

// The point of a triangle that is nearest to `p`. Triangles without extent are lines or points.
[[nodiscard]] glm::vec3 NearestInTriangle(const glm::vec3& p, const glm::vec3& a,
                                          const glm::vec3& b, const glm::vec3& c);

// Boxes within boxes round triangles, to find the nearest one without a look at all.
class TriangleTree {
 public:
  using Corners = std::array<glm::vec3, 3>;
  // Metres, finite. `names`: which triangles the tree holds.
  TriangleTree(std::span<const Corners> triangles, std::vector<std::uint32_t> names);

  struct Nearest {
    std::uint32_t triangle = 0;
    glm::vec3 position{0.0f};
  };
  // Of triangles as near as each other the lowest; the tree must hold one.
  [[nodiscard]] Nearest Find(const glm::vec3& p) const;

 private:
  struct Node {
    glm::vec3 low{0.0f}, high{0.0f};
    std::uint32_t first = 0;  // a leaf's triangles, or the second child (the first one follows)
    std::uint32_t count = 0;  // 0: not a leaf
  };
  struct Best;
  std::uint32_t Build(std::uint32_t first, std::uint32_t count);
  void Search(std::uint32_t node, const glm::vec3& p, Best* best) const;

  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> names_;
  std::vector<Node> nodes_;
};

}  // namespace furrow::character::bake
