// SPDX-License-Identifier: Apache-2.0
#include "render/skin/pixel_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

// What is not worth this in any channel lies beyond the kernel's reach.
constexpr float kMinWeight = 5e-4f;
// Of the places that are tried for taps, where pixels are finer; it bounds the time that takes.
constexpr float kMaxCellsPerMm = 24.0f;
// What is far from an edge counts for more, by this for every mm: smooth light knows a kernel by
// its variance, which its tail decides. As much of it as costs an edge nothing.
constexpr double kTail = 2.0;
constexpr double kAside = 0.2;  // of the way from the tap before, by a search from 0.1 to 0.5
constexpr float kMinSigma = 1.0f / 3.0f;  // pixels
constexpr int kGaussianSide = 3;          // taps of a Gaussian on one side

// The lit side of a straight edge, cell by cell, and staircases that follow it. Errors are squared,
// and count for more the further they are from the edge.
class EdgeResponse {
 public:
  EdgeResponse(const SkinProfile& profile, double cells_per_mm) {
    while (true) {
      const double mm = (cells() + 0.5) / cells_per_mm;
      const glm::dvec3 light(StepResponse(profile, mm));
      const glm::dvec3 rest = 1.0 - light;
      if (std::max({rest.r, rest.g, rest.b}) < kMinWeight) return;
      const double counts = 1.0 + kTail * mm;
      counts_.push_back(counts_.back() + counts);
      rests_.push_back(rests_.back() + counts * rest);
      squares_.push_back(squares_.back() + counts * glm::dot(rest, rest));
    }
  }

  // Up to where the response is 1 but for kMinWeight.
  [[nodiscard]] int cells() const { return static_cast<int>(rests_.size()) - 1; }

  // The best level for the cells [from, to), at least one.
  [[nodiscard]] glm::dvec3 Level(int from, int to) const {
    return 1.0 - (rests_[to] - rests_[from]) / (counts_[to] - counts_[from]);
  }

  // Where the steps of the best staircase begin, of `steps` in [1, cells()], the first at 0, and
  // after them where it is 1. By dynamic programming: the best m steps up to a cell are the best
  // m - 1 up to some cell before, and one more.
  [[nodiscard]] std::vector<int> BestSteps(int steps) const;

 private:
  // Of the best level for the cells [from, to).
  [[nodiscard]] double Error(int from, int to) const {
    const glm::dvec3 rest = rests_[to] - rests_[from];
    return squares_[to] - squares_[from] - glm::dot(rest, rest) / (counts_[to] - counts_[from]);
  }

  // Of the cells before [i]: how much they count, what they lack of 1, and the squares of that.
  std::vector<double> counts_{0.0};
  std::vector<glm::dvec3> rests_{glm::dvec3(0.0)};
  std::vector<double> squares_{0.0};
};

std::vector<int> EdgeResponse::BestSteps(int steps) const {
  const int n = cells();
  // Of the best m steps for the first j cells: their error, and where the last one begins.
  std::vector<double> errors(n + 1, 0.0);
  std::vector<std::vector<int>> starts(steps + 1, std::vector<int>(n + 2, 0));
  for (int j = 1; j <= n; ++j) errors[j] = Error(0, j);
  for (int m = 2; m <= steps; ++m) {
    const std::vector<double> before = errors;
    starts[m][n + 1] = n - 1;
    // The response rises, so last steps begin no earlier with more steps, and no later with fewer
    // cells (Knuth 1971): there is little to try.
    for (int j = n; j >= m; --j) {
      errors[j] = std::numeric_limits<double>::infinity();
      const int first = std::max(starts[m - 1][j], m - 1);
      const int last = std::max(first, std::min(starts[m][j + 1], j - 1));
      for (int i = first; i <= last; ++i) {
        const double error = before[i] + Error(i, j);
        if (error >= errors[j]) continue;
        errors[j] = error;
        starts[m][j] = i;
      }
    }
  }
  int end = n;
  for (int j = steps; j < n; ++j) {
    if (errors[j] - squares_[j] < errors[end] - squares_[end]) end = j;  // 1 from there
  }
  std::vector<int> best(steps + 1, end);
  for (int m = steps; m > 0; --m) best[m - 1] = starts[m][best[m]];
  return best;
}

}  // namespace

PixelTaps PixelKernel(const SkinProfile& profile, int taps, float pixels_per_mm) {
  const int pixels_per_cell =
      std::max(1, static_cast<int>(std::ceil(pixels_per_mm / kMaxCellsPerMm)));
  const EdgeResponse edge(profile, pixels_per_mm / static_cast<float>(pixels_per_cell));
  const int wanted = std::clamp(taps, kMinSeparableTaps, kMaxSeparableTaps) / 2;
  const int pairs = std::min(wanted, edge.cells());
  if (pairs == 0) return {{glm::vec2(0.0f)}, {glm::vec3(1.0f)}};
  const std::vector<int> places = edge.BestSteps(pairs);
  PixelTaps kernel;
  glm::dvec3 level(0.0);
  for (int i = 0; i <= pairs; ++i) {
    const glm::dvec3 next = i < pairs ? edge.Level(places[i], places[i + 1]) : glm::dvec3(1.0);
    // At the edge itself all of one side is lit, and the pixel: half, and half of its weight.
    const glm::dvec3 weight = i == 0 ? 2.0 * next - 1.0 : next - level;
    kernel.weights.emplace_back(glm::max(weight, 0.0));
    level = next;
    const int before = i == 0 ? 0 : places[i - 1];
    const double aside = std::round(kAside * (places[i] - before) * pixels_per_cell);
    kernel.offsets.emplace_back(places[i] * pixels_per_cell, aside);
  }
  return kernel;
}

// Samples of the Gaussian at whole pixels, each for the pixels that lie nearest to it, and then the
// centre's share chosen so that the variance is exact.
PixelTaps PixelGaussian(float sigma) {
  if (sigma < kMinSigma) return {{glm::vec2(0.0f)}, {glm::vec3(1.0f)}};
  std::array<int, kGaussianSide + 1> pixels{};
  for (int i = 1; i <= kGaussianSide; ++i) {
    const int nearest = static_cast<int>(std::lround(static_cast<float>(i) * sigma));
    pixels[i] = std::max(nearest, pixels[i - 1] + 1);
  }
  std::array<float, kGaussianSide + 1> weights{};
  float side = 0.0f;
  float variance = 0.0f;
  for (int i = 1; i <= kGaussianSide; ++i) {
    const auto x = static_cast<float>(pixels[i]);
    const int outer = i < kGaussianSide ? pixels[i + 1] : 2 * pixels[i] - pixels[i - 1];
    weights[i] = std::exp(-0.5f * x * x / (sigma * sigma)) * 0.5f *
                 static_cast<float>(outer - pixels[i - 1]);
    side += 2.0f * weights[i];
    variance += 2.0f * weights[i] * x * x;
  }
  // Of weights k w_i and a centre of 1 - k sum w_i, the variance is k times the sum of w_i x_i^2.
  const float scale = std::min(sigma * sigma / variance, 1.0f / side);
  PixelTaps kernel{{glm::vec2(0.0f)}, {glm::vec3(1.0f - scale * side)}};
  for (int i = 1; i <= kGaussianSide; ++i) {
    kernel.offsets.emplace_back(pixels[i], 0.0f);
    kernel.weights.emplace_back(scale * weights[i]);
  }
  return kernel;
}

}  // namespace furrow::render
