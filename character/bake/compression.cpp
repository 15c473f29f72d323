// SPDX-License-Identifier: Apache-2.0
#include "character/bake/compression.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::character::bake {
namespace {

using glm::vec3;
using wrinkle::PrincipalStretches;

Tensor2 Compose(float large, float small, const glm::vec2& direction) {
  const glm::vec2 d = direction;
  return {large * d.x * d.x + small * d.y * d.y, (large - small) * d.x * d.y,
          large * d.y * d.y + small * d.x * d.x};
}

// What is compressed of an averaged stretch.
Tensor2 CompressionOf(const Tensor2& stretch, float limit) {
  const Principal2 principal = PrincipalOf(stretch);  // `small` is the shorter stretch
  const float strong = std::clamp(1.0f - principal.small, 0.0f, limit);
  const float weak = std::clamp(1.0f - principal.large, 0.0f, limit);
  return Compose(strong, weak, {-principal.direction.y, principal.direction.x});
}

float Fourth(float x) { return x * x * x * x; }

}  // namespace

Principal2 PrincipalOf(const Tensor2& tensor) {
  const float mean = 0.5f * (tensor.xx + tensor.yy);
  const float half = 0.5f * (tensor.xx - tensor.yy);
  const float radius = std::hypot(half, tensor.xy);
  Principal2 principal{mean + radius, mean - radius, {1.0f, 0.0f}};
  if (radius > 1e-12f) {
    // Half the angle of (half, xy), without the loss of an atan2 and a sine.
    const float cosine = std::sqrt(std::max(0.0f, 0.5f * (1.0f + half / radius)));
    const float sine = std::sqrt(std::max(0.0f, 0.5f * (1.0f - half / radius)));
    principal.direction = {cosine, tensor.xy < 0.0f ? -sine : sine};
  }
  return principal;
}

CompressionSolver::CompressionSolver(const Surface& surface, float radius) : surface_(surface) {
  SurfaceReach reach(surface);
  starts_.push_back(0);
  for (std::size_t v = 0; v < surface.positions().size(); ++v) Gather(v, radius, &reach);
}

void CompressionSolver::Gather(std::size_t vertex, float radius, SurfaceReach* reach) {
  const std::size_t first = terms_.size();
  const vec3 here = surface_.positions()[vertex];
  const auto around = surface_.Around(vertex);
  const auto found = radius > 0.0f ? reach->Find(here, around, radius) : around;
  float sum = 0.0f;
  for (const std::uint32_t t : found) {
    const Surface::Triangle& triangle = surface_.triangles()[t];
    if (!triangle.strain) continue;
    const auto [a, b, c] = surface_.Corners(t);
    const float d = glm::distance(here, (a + b + c) / 3.0f);
    // The radius is two standard deviations; the triangles around a vertex always count.
    const float fall = radius > 0.0f ? std::exp(-2.0f * d * d / (radius * radius)) + 1e-4f : 1.0f;
    const float share = triangle.area * fall;
    terms_.push_back({t, share, Transport(triangle.axes, surface_.axes()[vertex])});
    sum += share;
  }
  for (std::size_t i = first; i < terms_.size(); ++i) terms_[i].share /= std::max(sum, 1e-30f);
  starts_.push_back(terms_.size());
}

std::vector<vec3> CompressionSolver::Pose(std::span<const glm::mat4> skin_matrices) const {
  std::vector<vec3> posed;
  posed.reserve(surface_.positions().size());
  for (std::size_t v = 0; v < surface_.positions().size(); ++v) {
    const Vertex& vertex = surface_.SourceOf(v);
    glm::vec4 sum(0.0f);
    for (int k = 0; k < 4; ++k) {
      if (vertex.skin_weights[k] == 0.0f) continue;
      sum += vertex.skin_weights[k] *
             (skin_matrices[vertex.joints[k]] * glm::vec4(surface_.positions()[v], 1.0f));
    }
    posed.emplace_back(sum);
  }
  return posed;
}

CompressionSolver::Field CompressionSolver::Solve(std::span<const glm::mat4> skin_matrices,
                                                  float limit) const {
  const std::vector<vec3> posed = Pose(skin_matrices);
  Field field;
  std::vector<Tensor2> stretches(surface_.triangles().size(), Tensor2{1.0f, 0.0f, 1.0f});
  for (std::size_t t = 0; t < stretches.size(); ++t) {
    const Surface::Triangle& triangle = surface_.triangles()[t];
    if (!triangle.strain) continue;
    const auto& v = triangle.vertices;
    const PrincipalStretches stretch = wrinkle::Principal(wrinkle::RightCauchyGreen(
        wrinkle::Deform(*triangle.strain, posed[v[0]], posed[v[1]], posed[v[2]])));
    field.worst = std::max(field.worst, std::min(1.0f - stretch.smallest, 1.0f));
    // Skinning gone wrong pulls some triangles to many times their length: that would drown the
    // compression beside them in the average.
    stretches[t] = Compose(std::min(stretch.largest, 1.0f + limit),
                           std::max(stretch.smallest, 1.0f - limit), stretch.largest_direction);
  }
  field.tensors.resize(surface_.positions().size());
  for (std::size_t i = 0; i < field.tensors.size(); ++i) {
    if (starts_[i] == starts_[i + 1]) continue;
    Tensor2 mean;
    for (std::size_t k = starts_[i]; k < starts_[i + 1]; ++k) {
      mean = mean + terms_[k].share * Carry(stretches[terms_[k].triangle], terms_[k].turn);
    }
    field.tensors[i] = CompressionOf(mean, limit);
  }
  return field;
}

void CompressionSum::Add(std::span<const Tensor2> tensors, std::span<const float> weights) {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Principal2 principal = PrincipalOf(weights[i] * tensors[i]);
    sums_[i] = sums_[i] + Compose(Fourth(principal.large), Fourth(std::max(principal.small, 0.0f)),
                                  principal.direction);
  }
}

std::vector<Tensor2> CompressionSum::Take() const {
  std::vector<Tensor2> field;
  field.reserve(sums_.size());
  for (const Tensor2& sum : sums_) {
    const Principal2 principal = PrincipalOf(sum);
    field.push_back(Compose(std::sqrt(std::sqrt(std::max(principal.large, 0.0f))),
                            std::sqrt(std::sqrt(std::max(principal.small, 0.0f))),
                            principal.direction));
  }
  return field;
}

}  // namespace furrow::character::bake
