// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/weight_gradients.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/mesh/weld.h"

namespace furrow::render {
namespace {

using character::Vertex;
using glm::vec2;
using glm::vec3;

float WeightOf(const Vertex& vertex, std::uint16_t joint) {
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) sum += vertex.joints[k] == joint ? vertex.skin_weights[k] : 0.0f;
  return sum;
}

vec3 UnitOrZero(const vec3& v) {
  const float length = glm::length(v);
  return length > 1e-12f ? v / length : vec3(0.0f);
}

// The neighbours of each point of the welded surface, each at least once.
std::vector<std::vector<std::uint32_t>> NeighboursOf(const character::Mesh& mesh,
                                                     const std::vector<std::uint32_t>& welded) {
  std::vector<std::vector<std::uint32_t>> neighbours(mesh.vertices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = welded[mesh.indices[i + k]];
      const std::uint32_t b = welded[mesh.indices[i + (k + 1) % 3]];
      if (a == b) continue;
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
  }
  return neighbours;
}

// The gradient of one joint's weight along the axes of a tangent plane: the least-squares fit of
// the changes towards the neighbours. Near and distant neighbours count alike.
class GradientFit {
 public:
  GradientFit(const Vertex& vertex, const vec3& along, const vec3& across)
      : vertex_(vertex), along_(along), across_(across) {}

  void Add(const Vertex& neighbour) {
    const vec3 step = neighbour.position - vertex_.position;
    const vec2 flat(glm::dot(step, along_), glm::dot(step, across_));
    const float length = glm::length(step), flat_length = glm::length(flat);
    if (!(flat_length > 1e-3f * length)) return;
    const vec2 towards = flat / flat_length;
    xx_ += towards.x * towards.x;
    xy_ += towards.x * towards.y;
    yy_ += towards.y * towards.y;
    for (int k = 0; k < 4; ++k) {
      if (vertex_.skin_weights[k] <= 0.0f) continue;
      const std::uint16_t joint = vertex_.joints[k];
      const float change = (WeightOf(neighbour, joint) - WeightOf(vertex_, joint)) / length;
      x_[k] += towards.x * change;
      y_[k] += towards.y * change;
    }
  }

  [[nodiscard]] WeightGradient Solve() const {
    const float determinant = xx_ * yy_ - xy_ * xy_;
    // Neighbours in one line do not tell the change across it.
    if (!(determinant > 1e-3f * (xx_ + yy_) * (xx_ + yy_))) return {};
    return {(x_ * yy_ - y_ * xy_) / determinant, (y_ * xx_ - x_ * xy_) / determinant};
  }

 private:
  const Vertex& vertex_;
  vec3 along_, across_;
  float xx_ = 0.0f, xy_ = 0.0f, yy_ = 0.0f;
  glm::vec4 x_{0.0f}, y_{0.0f};
};

bool IsZero(const WeightGradient& gradient) {
  constexpr float kLeast = 1e-4f;  // per metre
  for (int k = 0; k < 4; ++k) {
    if (std::abs(gradient.along[k]) > kLeast || std::abs(gradient.across[k]) > kLeast) return false;
  }
  return true;
}

}  // namespace

std::vector<WeightGradient> WeightGradients(const character::Mesh& mesh) {
  const std::vector<std::uint32_t> welded = character::WeldVertices(mesh);
  const auto neighbours = NeighboursOf(mesh, welded);
  std::vector<WeightGradient> gradients;
  gradients.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vertex& vertex = mesh.vertices[v];
    const vec3 across = UnitOrZero(glm::cross(vertex.normal, vec3(vertex.tangent)));
    GradientFit fit(vertex, UnitOrZero(glm::cross(across, vertex.normal)), across);
    for (const std::uint32_t neighbour : neighbours[welded[v]]) fit.Add(mesh.vertices[neighbour]);
    gradients.push_back(fit.Solve());
  }
  if (std::ranges::all_of(gradients, IsZero)) gradients.clear();
  return gradients;
}

}  // namespace furrow::render
