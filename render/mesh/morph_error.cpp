// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/morph_error.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

// The barycentric coordinates of the point's projection on a triangle, drawn into the triangle.
glm::dvec3 PlaceOn(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point) {
  const glm::dvec3 a = corners[1] - corners[0];
  const glm::dvec3 b = corners[2] - corners[0];
  const glm::dvec3 p = point - corners[0];
  const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b);
  const double scale = aa * bb - ab * ab;
  if (!(scale > 1e-12 * aa * bb)) return {1.0, 0.0, 0.0};
  const double u = (bb * glm::dot(p, a) - ab * glm::dot(p, b)) / scale;
  const double v = (aa * glm::dot(p, b) - ab * glm::dot(p, a)) / scale;
  const glm::dvec3 shares = glm::max(glm::dvec3(1.0 - u - v, u, v), glm::dvec3(0.0));
  return shares / (shares.x + shares.y + shares.z);
}

}  // namespace

MorphError::MorphError(const character::Mesh& mesh) : sums_(mesh.morph_targets.size()) {
  first_.assign(mesh.vertices.size() + 1, 0);
  for (const character::MorphTarget& target : mesh.morph_targets) {
    for (const character::MorphDelta& delta : target.deltas) {
      if (delta.position != glm::vec3(0.0f)) ++first_[delta.vertex + 1];
    }
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  deltas_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t target = 0; target < mesh.morph_targets.size(); ++target) {
    for (const character::MorphDelta& delta : mesh.morph_targets[target].deltas) {
      if (delta.position == glm::vec3(0.0f)) continue;
      deltas_[next[delta.vertex]++] = {target, delta.position};
    }
  }
}

void MorphError::Add(std::uint32_t vertex, double share) {
  for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
    sums_[deltas_[i].target] += share * glm::dvec3(deltas_[i].position);
    touched_.push_back(deltas_[i].target);
  }
}

// Subtracts how the nearest place on the triangles moves.
void MorphError::SubtractPlace(const glm::dvec3& point, std::span<const Triangle> triangles,
                               std::span<const glm::dvec3> positions) {
  const Triangle* nearest = nullptr;
  glm::dvec3 place(0.0);
  double least = std::numeric_limits<double>::max();
  for (const Triangle& triangle : triangles) {
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = positions[triangle[i]];
    const glm::dvec3 shares = PlaceOn(corners, point);
    const glm::dvec3 at = shares.x * corners[0] + shares.y * corners[1] + shares.z * corners[2];
    const double distance = glm::distance(at, point);
    if (distance >= least) continue;
    least = distance;
    nearest = &triangle;
    place = shares;
  }
  for (int i = 0; nearest != nullptr && i < 3; ++i) {
    Add((*nearest)[static_cast<std::size_t>(i)], -place[i]);
  }
}

double MorphError::TakeLongest() {
  double longest = 0.0;
  for (const std::uint32_t target : touched_) {
    longest = std::max(longest, glm::length(sums_[target]));
    sums_[target] = glm::dvec3(0.0);
  }
  touched_.clear();
  return longest;
}

double MorphError::AtVertex(std::uint32_t vertex, std::span<const Triangle> after,
                            std::span<const glm::dvec3> positions) {
  Add(vertex, 1.0);
  SubtractPlace(positions[vertex], after, positions);
  return TakeLongest();
}

double MorphError::Between(std::uint32_t vertex, std::span<const Triangle> before,
                           std::span<const Triangle> after, std::span<const glm::dvec3> positions) {
  constexpr double kSamples[] = {0.25, 0.5, 0.75};
  double error = AtVertex(vertex, after, positions);
  for (const Triangle& triangle : before) {
    for (const std::uint32_t end : triangle) {
      if (end == vertex) continue;
      for (const double share : kSamples) {
        Add(vertex, 1.0 - share);
        Add(end, share);
        const glm::dvec3 point = glm::mix(positions[vertex], positions[end], share);
        SubtractPlace(point, after, positions);
        error = std::max(error, TakeLongest());
      }
    }
  }
  return error;
}

}  // namespace furrow::render
