// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_relief.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/cell_grid.h"
#include "authoring/bake/cloth/sheet_math.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kCell = 0.02f;  // metres
// Excess from which on crests are broad instead of round.
constexpr float kRound = 0.08f;
constexpr float kBroad = 0.22f;

// The nearest point of a crease to a vertex.
struct Nearest {
  std::uint32_t crease = 0xffffffffu;
  float distance = 0.0f;
  float height = 0.0f;
};

// The cross-section of a crest, 1 at its top and 0 from `q` = 1 on.
float Section(float q, float broad) {
  if (q >= 1.0f) return 0.0f;
  const float round = 0.5f * (1.0f + std::cos(kPi * q));
  const float arch = 1.0f - q * q;
  return std::lerp(round, arch, broad);
}

}  // namespace

float CrestHeight(float w, float hidden, float spacing, const ReliefOptions& options) {
  const float height = options.height * std::sqrt(w * std::max(hidden, 0.0f));
  if (!(w > 0.0f)) return 0.0f;
  const float steepest =
      options.steepest * std::lerp(0.6f, 1.0f, Smoothstep(0.12f, 0.45f, hidden / w));
  const float most = std::min(0.25f * steepest * w, options.highest * spacing);
  return most > 0.0f ? most * std::tanh(height / most) : 0.0f;
}

std::vector<float> DrawCreases(const FineMesh& mesh, std::span<const Crease> creases,
                               const ReliefOptions& options) {
  const std::size_t count = mesh.positions().size();
  const std::vector<vec3> normals = NormalsOf(mesh);
  CellGrid<std::uint32_t> grid(kCell);
  for (std::uint32_t v = 0; v < count; ++v) grid.Add(mesh.positions()[v], v);
  std::vector<float> fourths(count, 0.0f);
  std::vector<Nearest> nearest(count);
  std::vector<std::uint32_t> touched;
  for (std::uint32_t c = 0; c < creases.size(); ++c) {
    const std::vector<Crease::Point>& points = creases[c].points;
    touched.clear();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Crease::Point &a = points[i], &b = points[i + 1];
      const vec3 step = b.place - a.place;
      const float square = glm::dot(step, step);
      if (!(square > 1e-12f)) continue;
      const float reach = std::max({a.left, a.right, b.left, b.right});
      const vec3 low = glm::min(a.place, b.place) - vec3(reach);
      const vec3 high = glm::max(a.place, b.place) + vec3(reach);
      grid.Within(low, high, [&](std::uint32_t v) {
        if (glm::dot(normals[v], a.normal) < kSameSide) return;
        const vec3 offset = mesh.positions()[v] - a.place;
        const float t = glm::dot(offset, step) / square;
        const float s = Saturate(t);
        const float distance = glm::length(offset - s * step);
        if (distance > reach) return;
        Nearest& here = nearest[v];
        if (here.crease == c && here.distance <= distance) return;
        if (here.crease != c) touched.push_back(v);
        const float strength = std::lerp(a.strength, b.strength, s);
        // Ends become narrow with their depth.
        const float narrow = std::sqrt(strength);
        const float excess = std::lerp(a.excess, b.excess, s);
        const float broad = Smoothstep(kRound, kBroad, excess);
        // A crest hides the excess up to its neighbours, but needs not be as wide.
        const float most = std::lerp(options.narrow, 1.0f, broad) * a.spacing;
        const float all_left = std::lerp(a.left, b.left, s);
        const float all_right = std::lerp(a.right, b.right, s);
        const float left = narrow * std::min(all_left, most);
        const float right = narrow * std::min(all_right, most);
        const bool on_left = glm::dot(glm::cross(a.normal, step), offset) > 0.0f;
        const float half = std::max(on_left ? left : right, 1e-4f);
        const float hidden = narrow * strength * excess * (all_left + all_right);
        const float height = CrestHeight(left + right, hidden, a.spacing, options);
        here = {c, distance, height * Section(distance / half, broad)};
      });
    }
    for (const std::uint32_t v : touched) {
      const float square = nearest[v].height * nearest[v].height;
      fourths[v] += square * square;
    }
  }
  for (float& value : fourths) value = std::sqrt(std::sqrt(value));
  return fourths;
}

}  // namespace furrow::authoring
