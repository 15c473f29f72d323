// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::authoring {

// The point of the edge from `a` to `b` that is nearest to `p`. An edge of length 0 is a point.
[[nodiscard]] glm::vec3 NearestOnEdge(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b);

// The point of a triangle that is nearest to `p`. Degenerate triangles are lines or points.
[[nodiscard]] glm::vec3 NearestInTriangle(const glm::vec3& p, const glm::vec3& a,
                                          const glm::vec3& b, const glm::vec3& c);

// A hierarchy of bounding boxes that finds the nearest triangle without testing all of them.
class TriangleTree {
 public:
  using Corners = std::array<glm::vec3, 3>;
  // `triangles`: finite corners in metres. `names`: indices in `triangles` of those to put into the
  // tree. Copies what it needs.
  TriangleTree(std::span<const Corners> triangles, std::vector<std::uint32_t> names);

  struct Nearest {
    std::uint32_t triangle = 0;  // index in `triangles`
    glm::vec3 position{0.0f};    // nearest point, metres
  };
  // The nearest triangle; of equally near ones the lowest index. Precondition: the tree is not
  // empty.
  [[nodiscard]] Nearest Find(const glm::vec3& p) const;

 private:
  struct Node {
    glm::vec3 low{0.0f}, high{0.0f};
    // Leaf: index of its first triangle. Other: index of the second child; the first child follows
    // the node.
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: not a leaf
  };
  struct Best;
  std::uint32_t Build(std::uint32_t first, std::uint32_t count);
  void Search(std::uint32_t node, const glm::vec3& p, Best* best) const;

  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> names_;
  std::vector<Node> nodes_;
};

}  // namespace furrow::authoring
