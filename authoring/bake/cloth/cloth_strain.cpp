// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/cloth_strain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/bake/surface/compression.h"
#include "wrinkle/drivers/strain/strain.h"

namespace furrow::authoring {
namespace {

using glm::mat3;
using glm::vec3;

// Broken skinning stretches some edges to many times their length.
constexpr float kMostStretch = 0.5f;
// The share of the difference along an edge that flows per step; stable for twelve edges.
constexpr float kFlow = 1.0f / 12.0f;
// The variance that a step adds along the compression, in squared edges, for six even edges.
constexpr float kSpreadPerStep = 0.1875f;
// How much length the cloth around a pull loses, per stretch that reaches it by diffusion, which
// leaves less at the sides of a limb than there is on its outside.
constexpr float kFed = 1.5f;
// Edges shorter than this times the mean conduct less than they should.
constexpr float kEvenEdge = 0.7f;
constexpr float kMostSteps = 1e4f;
constexpr float kTiny = 1e-6f;

// The part of a symmetric tensor across `normal` that has positive eigenvalues.
mat3 PositiveAcross(const mat3& tensor, const vec3& normal) {
  const wrinkle::SurfaceAxes axes = AxesAcross(normal);
  const vec3 x = tensor * axes.x, y = tensor * axes.y;
  const Principal2 principal =
      PrincipalOf({glm::dot(axes.x, x), glm::dot(axes.x, y), glm::dot(axes.y, y)});
  const vec3 first = axes.x * principal.direction.x + axes.y * principal.direction.y;
  const vec3 second = glm::cross(normal, first);
  return std::max(principal.large, 0.0f) * glm::outerProduct(first, first) +
         std::max(principal.small, 0.0f) * glm::outerProduct(second, second);
}

// An edge between two vertices with room.
struct Flow {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  vec3 along{0.0f};    // unit vector at rest
  float share = 0.0f;  // of the difference between the ends, per step
};

// The values after `steps` steps of diffusion, in which each edge moves its share of the difference
// between its ends. The number of passes is about the root of twice that: the first-order
// super-time-stepping of Meyer, Balsara and Aslam (A stabilized Runge-Kutta-Legendre method, 2014).
std::vector<mat3> Diffused(const std::vector<mat3>& values, std::span<const Flow> flows,
                           float steps) {
  const int stages =
      std::max(static_cast<int>(std::ceil(std::sqrt(2.0f * steps + 0.25f) - 0.5f)), 1);
  const auto last = static_cast<float>(stages);
  const float pass = 2.0f * steps / (last * last + last);
  std::vector<mat3> before = values, now = values, change(values.size());
  for (int k = 1; k <= stages; ++k) {
    std::fill(change.begin(), change.end(), mat3(0.0f));
    for (const Flow& flow : flows) {
      const mat3 moved = flow.share * (now[flow.b] - now[flow.a]);
      change[flow.a] += moved;
      change[flow.b] -= moved;
    }
    const auto j = static_cast<float>(k);
    const float mu = k == 1 ? 1.0f : (2.0f * j - 1.0f) / j;
    const float nu = 1.0f - mu;
    for (std::size_t v = 0; v < values.size(); ++v) {
      const mat3 next = mu * now[v] + nu * before[v] + (mu * pass) * change[v];
      before[v] = now[v];
      now[v] = next;
    }
  }
  return now;
}

// Spreads the changes of length of the cloth with room.
class Spread {
 public:
  Spread(const FineMesh& mesh, std::span<const float> room) : mesh_(mesh), index_(room.size(), 0) {
    std::vector<vec3> normals;
    for (const wrinkle::SurfaceAxes& axes : mesh.surface().axes()) normals.push_back(axes.normal);
    for (std::uint32_t v = 0; v < room.size(); ++v) {
      if (!(room[v] > 0.0f)) continue;
      index_[v] = static_cast<std::uint32_t>(vertices_.size()) + 1;
      vertices_.push_back(v);
      const vec3 normal = mesh.vertices()[v].Interpolate(std::span<const vec3>(normals));
      const float length = glm::length(normal);
      normals_.push_back(length > kTiny ? normal / length : vec3(0.0f, 0.0f, 1.0f));
    }
  }

  [[nodiscard]] ClothStrain Measure(std::span<const vec3> cut, std::span<const vec3> posed,
                                    const ClothSlip& slip) {
    ClothStrain strain{std::vector<mat3>(mesh_.vertices().size(), mat3(0.0f)),
                       std::vector<mat3>(mesh_.vertices().size(), mat3(0.0f)),
                       std::vector<float>(mesh_.vertices().size(), 0.0f)};
    std::vector<mat3> lost = Changes(cut, posed), pulled = lost;
    if (flows_.empty()) return strain;
    for (std::size_t i = 0; i < lost.size(); ++i) {
      pulled[i] = PositiveAcross(-1.0f * lost[i] - mat3(slip.stretches), normals_[i]);
      lost[i] = PositiveAcross(lost[i], normals_[i]);
    }
    const float edge = kEvenEdge * mean_edge_;
    for (Flow& flow : flows_) flow.share = kFlow * std::min(edge * edge / flow.share, 1.0f);
    const auto steps = [&](float length) {
      return std::min(length * length / (kSpreadPerStep * edge * edge), kMostSteps);
    };
    const std::vector<mat3> fed = Diffused(pulled, flows_, steps(slip.fed));
    pulled = Diffused(pulled, flows_, steps(slip.pulled));
    // Cloth slips along the direction in which it is compressed nearby.
    const std::vector<mat3> nearby = Diffused(lost, flows_, 0.5f * steps(slip.pressed));
    for (Flow& flow : flows_) {
      const mat3 sum = nearby[flow.a] + nearby[flow.b];
      const float trace = TraceOf(sum);
      const float along = glm::dot(flow.along, sum * flow.along);
      flow.share *= trace < kTiny ? 0.0f : std::clamp(along / trace, 0.0f, 1.0f);
    }
    lost = Diffused(lost, flows_, steps(slip.pressed));
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const mat3 given = kFed * slip.feeds * PositiveAcross(fed[i] - pulled[i], normals_[i]);
      strain.lost[vertices_[i]] = PositiveAcross(lost[i] + given, normals_[i]);
      strain.fed[vertices_[i]] = TraceOf(given);
      strain.pulled[vertices_[i]] = PositiveAcross(pulled[i], normals_[i]);
    }
    return strain;
  }

 private:
  // The shares of length that the pose takes from the cut, per vertex with room; negative where it
  // stretches. Lists the flows, with their squared lengths as shares.
  std::vector<mat3> Changes(std::span<const vec3> cut, std::span<const vec3> posed) {
    std::vector<mat3> changes(vertices_.size(), mat3(0.0f));
    std::vector<float> edges(vertices_.size(), 0.0f);
    double length = 0.0;
    for (const auto& [a, b] : mesh_.edges()) {
      if (index_[a] == 0 || index_[b] == 0) continue;
      const vec3 step = mesh_.positions()[b] - mesh_.positions()[a];
      const float rest = glm::length(step);
      const float before = glm::distance(cut[a], cut[b]);
      if (rest < kTiny || before < kTiny) continue;
      const Flow flow{index_[a] - 1, index_[b] - 1, step / rest, rest * rest};
      const float share =
          std::max(1.0f - glm::distance(posed[a], posed[b]) / before, -kMostStretch);
      for (const std::uint32_t end : {flow.a, flow.b}) {
        changes[end] += share * glm::outerProduct(flow.along, flow.along);
        edges[end] += 1.0f;
      }
      flows_.push_back(flow);
      length += static_cast<double>(rest);
    }
    mean_edge_ =
        static_cast<float>(length / static_cast<double>(std::max<std::size_t>(flows_.size(), 1)));
    // Over all directions d across the normal, the mean of (d T d) d d^T is (2 T + tr T) / 8. This
    // inverts it.
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const mat3 mean = changes[i] * (1.0f / std::max(edges[i], 1.0f));
      const vec3& n = normals_[i];
      const mat3 plane = mat3(1.0f) - glm::outerProduct(n, n);
      changes[i] = plane * (4.0f * mean - TraceOf(mean) * mat3(1.0f)) * plane;
    }
    return changes;
  }

  const FineMesh& mesh_;
  std::vector<std::uint32_t> index_;     // per vertex of the mesh: 1 + its place below, or 0
  std::vector<std::uint32_t> vertices_;  // those with room
  std::vector<vec3> normals_;            // at rest
  std::vector<Flow> flows_;
  float mean_edge_ = 0.0f;  // metres
};

}  // namespace

ClothStrain MeasureClothStrain(const FineMesh& mesh, std::span<const vec3> cut,
                               std::span<const vec3> posed, std::span<const float> room,
                               const ClothSlip& slip) {
  return Spread(mesh, room).Measure(cut, posed, slip);
}

}  // namespace furrow::authoring
