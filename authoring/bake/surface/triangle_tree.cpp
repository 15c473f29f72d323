// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/triangle_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr std::uint32_t kLeaf = 4;  // triangles per leaf

float SquareOf(const vec3& v) { return glm::dot(v, v); }

vec3 NearestOnBorder(const vec3& p, const vec3& a, const vec3& b, const vec3& c) {
  vec3 best = NearestOnEdge(p, a, b);
  for (const vec3& other : {NearestOnEdge(p, b, c), NearestOnEdge(p, c, a)}) {
    if (SquareOf(p - other) < SquareOf(p - best)) best = other;
  }
  return best;
}

// 0 inside the box.
float SquareToBox(const vec3& p, const vec3& low, const vec3& high) {
  return SquareOf(p - glm::clamp(p, low, high));
}

}  // namespace

vec3 NearestOnEdge(const vec3& p, const vec3& a, const vec3& b) {
  const vec3 along = b - a;
  const float square = SquareOf(along);
  if (!(square > 0.0f)) return a;
  return a + along * std::clamp(glm::dot(p - a, along) / square, 0.0f, 1.0f);
}

vec3 NearestInTriangle(const vec3& p, const vec3& a, const vec3& b, const vec3& c) {
  const vec3 ab = b - a, ac = c - a;
  const vec3 normal = glm::cross(ab, ac);
  const float square = SquareOf(normal);
  // A narrower triangle is treated as its border, since its inside is below rounding errors.
  if (!(square > 1e-12f * SquareOf(ab) * SquareOf(ac))) return NearestOnBorder(p, a, b, c);
  const vec3 ap = p - a;
  const float v = glm::dot(glm::cross(ap, ac), normal), w = glm::dot(glm::cross(ab, ap), normal);
  if (v >= 0.0f && w >= 0.0f && v + w <= square) return a + (ab * v + ac * w) / square;
  return NearestOnBorder(p, a, b, c);
}

struct TriangleTree::Best {
  float square = std::numeric_limits<float>::infinity();
  Nearest nearest;
};

TriangleTree::TriangleTree(std::span<const Corners> triangles, std::vector<std::uint32_t> names)
    : triangles_(triangles.begin(), triangles.end()), names_(std::move(names)) {
  if (!names_.empty()) Build(0, static_cast<std::uint32_t>(names_.size()));
}

// Splits at the median, so the depth is logarithmic for any input. Equal middles are ordered by
// index, so the tree is repeatable.
std::uint32_t TriangleTree::Build(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.low = node.high = triangles_[names_[first]][0];
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const vec3& corner : triangles_[names_[i]]) {
      node.low = glm::min(node.low, corner);
      node.high = glm::max(node.high, corner);
    }
  }
  nodes_.push_back(node);
  if (count <= kLeaf) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  const vec3 extent = node.high - node.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = [&](std::uint32_t t) {
    return triangles_[t][0][axis] + triangles_[t][1][axis] + triangles_[t][2][axis];
  };
  const auto begin = names_.begin() + first;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(middle(a), a) < std::pair(middle(b), b);
  });
  Build(first, half);
  const std::uint32_t second = Build(first + half, count - half);
  nodes_[index].first = second;
  return index;
}

void TriangleTree::Search(std::uint32_t index, const vec3& p, Best* best) const {
  const Node& node = nodes_[index];
  if (SquareToBox(p, node.low, node.high) > best->square) return;
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    const std::uint32_t t = names_[i];
    const auto& [a, b, c] = triangles_[t];
    const vec3 position = NearestInTriangle(p, a, b, c);
    const float square = SquareOf(p - position);
    const bool nearer = square < best->square;
    if (!nearer && !(square == best->square && t < best->nearest.triangle)) continue;
    *best = {square, {t, position}};
  }
  if (node.count > 0) return;
  // The nearer child first: the distance found there usually excludes the other one.
  std::uint32_t near = index + 1, far = node.first;
  const auto distance = [&](std::uint32_t child) {
    return SquareToBox(p, nodes_[child].low, nodes_[child].high);
  };
  if (distance(far) < distance(near)) std::swap(near, far);
  Search(near, p, best);
  Search(far, p, best);
}

TriangleTree::Nearest TriangleTree::Find(const vec3& p) const {
  Best best;
  Search(0, p, &best);
  return best.nearest;
}

}  // namespace furrow::authoring
