// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/compression.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;
using wrinkle::PrincipalStretches;

// The tensor with the eigenvalue `large` along the unit vector `direction` and `small` across it.
Tensor2 Compose(float large, float small, const glm::vec2& direction) {
  const glm::vec2 d = direction;
  return {large * d.x * d.x + small * d.y * d.y, (large - small) * d.x * d.y,
          large * d.y * d.y + small * d.x * d.x};
}

// The compression of an averaged stretch. A sheet that is stretched to s times its length narrows
// to 1 / sqrt(s) of its width, since it keeps its volume. Only narrowing beyond that makes folds.
Tensor2 CompressionOf(const Tensor2& stretch, float limit) {
  const Principal2 principal = PrincipalOf(stretch);  // `small` is the smaller stretch
  const float narrowed = principal.small * std::sqrt(std::max(principal.large, 1.0f));
  const float strong = std::clamp(1.0f - narrowed, 0.0f, limit);
  const float weak = std::clamp(1.0f - principal.large, 0.0f, limit);
  return Compose(strong, weak, {-principal.direction.y, principal.direction.x});
}

constexpr std::size_t kMaxTerms = 64;  // per vertex

float Fourth(float x) { return x * x * x * x; }

}  // namespace

Principal2 PrincipalOf(const Tensor2& tensor) {
  const float mean = 0.5f * (tensor.xx + tensor.yy);
  const float half = 0.5f * (tensor.xx - tensor.yy);
  const float radius = std::hypot(half, tensor.xy);
  Principal2 principal{mean + radius, mean - radius, {1.0f, 0.0f}};
  if (radius > 1e-12f) {
    // Half the angle of (half, xy). This is more accurate than atan2 followed by sine and cosine.
    const float cosine = std::sqrt(std::max(0.0f, 0.5f * (1.0f + half / radius)));
    const float sine = std::sqrt(std::max(0.0f, 0.5f * (1.0f - half / radius)));
    principal.direction = {cosine, tensor.xy < 0.0f ? -sine : sine};
  }
  return principal;
}

CompressionSolver::CompressionSolver(const Surface& surface, float radius, BakeProgress* progress)
    : surface_(surface) {
  SurfaceSearch reach(surface);
  std::vector<Term> terms;
  starts_.push_back(0);
  for (std::size_t v = 0; v < surface.positions().size(); ++v) {
    if (!progress->ReportStep(v, surface.positions().size())) return;
    Gather(v, radius, &reach, &terms);
    if (terms.size() > kMaxTerms) LimitTerms(&terms);
    terms_.insert(terms_.end(), terms.begin(), terms.end());
    starts_.push_back(terms_.size());
  }
}

// Keeps at most kMaxTerms terms, each in proportion to its share. Neighbours in a mesh's list are
// mostly neighbours on the surface, so samples at even steps along the list are spread evenly over
// the surface.
void CompressionSolver::LimitTerms(std::vector<Term>* terms) {
  constexpr float kPick = 1.0f / static_cast<float>(kMaxTerms);
  std::sort(terms->begin(), terms->end(),
            [](const Term& a, const Term& b) { return a.triangle < b.triangle; });
  std::vector<Term> kept;
  float passed = 0.0f, next = 0.5f * kPick;
  for (Term& term : *terms) {
    passed += term.share;
    term.share = 0.0f;
    for (; next < passed && next < 1.0f; next += kPick) term.share += kPick;
    if (term.share > 0.0f) kept.push_back(term);
  }
  terms->swap(kept);
}

// Lists the triangles that a vertex averages, with normalised shares and the rotation that carries
// their tensors to the vertex. This depends on the rest pose only and is done once for all poses.
void CompressionSolver::Gather(std::size_t vertex, float radius, SurfaceSearch* reach,
                               std::vector<Term>* terms) {
  terms->clear();
  const vec3 here = surface_.positions()[vertex];
  const auto around = surface_.Around(vertex);
  const auto found = radius > 0.0f ? reach->Find(here, around, radius) : around;
  float sum = 0.0f;
  for (const std::uint32_t t : found) {
    const Surface::Triangle& triangle = surface_.triangles()[t];
    if (!triangle.strain) continue;
    const auto [a, b, c] = surface_.Corners(t);
    const float d = glm::distance(here, (a + b + c) / 3.0f);
    // The radius is two standard deviations. The triangles around a vertex always count.
    const float fall = radius > 0.0f ? std::exp(-2.0f * d * d / (radius * radius)) + 1e-4f : 1.0f;
    const float share = triangle.area * fall;
    terms->push_back({t, share, Transport(triangle.axes, surface_.axes()[vertex])});
    sum += share;
  }
  for (Term& term : *terms) term.share /= std::max(sum, 1e-30f);
}

Tensor2 CompressionSolver::StretchOf(std::size_t triangle, std::span<const PosedVertex> posed,
                                     float limit, float* worst) const {
  const Surface::Triangle& t = surface_.triangles()[triangle];
  if (!t.strain) return {1.0f, 0.0f, 1.0f};
  const PosedVertex& a = posed[t.vertices[0]];
  const PosedVertex& b = posed[t.vertices[1]];
  const PosedVertex& c = posed[t.vertices[2]];
  const wrinkle::DeformationGradient f =
      wrinkle::Deform(*t.strain, a.position, b.position, c.position);
  const PrincipalStretches stretch = wrinkle::Principal(wrinkle::RightCauchyGreen(f));
  const glm::mat3 turn = a.turn + b.turn + c.turn;
  // A principal direction that points against the skinned rotation means that the triangle has
  // turned inside out in this direction.
  const auto is_flipped = [&](const glm::vec2& direction) {
    return glm::dot(wrinkle::ToPosedSpace(f, direction),
                    turn * wrinkle::ToRestSpace(t.axes, direction)) < 0.0f;
  };
  const float large = is_flipped(stretch.largest_direction) ? -stretch.largest : stretch.largest;
  const float small = is_flipped(stretch.smallest_direction) ? -stretch.smallest : stretch.smallest;
  *worst = std::max(*worst, std::min(1.0f - std::min(large, small), 1.0f));
  // Broken skinning stretches some triangles to many times their length. Without the limit they
  // would outweigh the compression beside them in the average.
  return Compose(std::clamp(large, 1.0f - limit, 1.0f + limit),
                 std::clamp(small, 1.0f - limit, 1.0f + limit), stretch.largest_direction);
}

bool CompressionSolver::IsSliver(std::size_t triangle) const {
  constexpr float kLongest = 12.0f;  // edge per height
  const auto [a, b, c] = surface_.Corners(static_cast<std::uint32_t>(triangle));
  const float edge = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  // The height on the longest edge is twice the area divided by the edge.
  return edge * edge > kLongest * 2.0f * surface_.triangles()[triangle].area;
}

CompressionSolver::Field CompressionSolver::Solve(std::span<const glm::mat4> skin_matrices,
                                                  std::span<const float> shape_weights,
                                                  float limit) const {
  const bool shaped = !shape_weights.empty();
  const std::vector<vec3> morphed = shaped ? surface_.Morphed(shape_weights) : std::vector<vec3>();
  const std::vector<PosedVertex> posed = PoseSurface(
      surface_, skin_matrices, shaped ? std::span<const vec3>(morphed) : surface_.positions());
  Field field;
  std::vector<Tensor2> stretches;
  stretches.reserve(surface_.triangles().size());
  for (std::size_t t = 0; t < surface_.triangles().size(); ++t) {
    stretches.push_back(shaped && IsSliver(t) ? Tensor2{1.0f, 0.0f, 1.0f}
                                              : StretchOf(t, posed, limit, &field.worst));
  }
  field.tensors.resize(surface_.positions().size());
  field.growth.resize(surface_.positions().size(), 1.0f);
  for (std::size_t i = 0; i < field.tensors.size(); ++i) {
    if (starts_[i] == starts_[i + 1]) continue;
    Tensor2 mean;
    for (std::size_t k = starts_[i]; k < starts_[i + 1]; ++k) {
      mean = mean + terms_[k].share * Carry(stretches[terms_[k].triangle], terms_[k].turn);
    }
    field.tensors[i] = CompressionOf(mean, limit);
    // The determinant of the mean stretch is the change of area.
    field.growth[i] = std::max(mean.xx * mean.yy - mean.xy * mean.xy, 0.0f);
  }
  return field;
}

// Fourth powers and a fourth root in Take(): close to the largest compression over all poses, but
// smooth, and directions blend instead of jumping.
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

}  // namespace furrow::authoring
