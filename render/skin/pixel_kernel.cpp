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

// The kernel ends where the remaining response of every channel is below this.
constexpr float kMinWeight = 5e-4f;
// Limit of the resolution at which tap positions are searched. It bounds the search time.
constexpr float kMaxCellsPerMm = 24.0f;
// Weight per mm of distance from the edge. Smooth light depends mostly on a kernel's variance, and
// thus on its tail. The value is as large as possible without making the edge worse.
constexpr double kTail = 2.0;
constexpr double kAside = 0.2;  // shift as a share of the distance to the tap before; best of a
                                // search from 0.1 to 0.5
constexpr float kMinSigma = 1.0f / 3.0f;  // pixels
constexpr int kGaussianSide = 3;          // taps of a Gaussian on one side

// The profile's response to a straight edge on its lit side, cell by cell, and the staircases that
// approximate it. Errors are squared and weighted by the distance from the edge.
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

  // Number of cells until the response is within kMinWeight of 1.
  [[nodiscard]] int cells() const { return static_cast<int>(rests_.size()) - 1; }

  // The best level for the cells [from, to), at least one cell.
  [[nodiscard]] glm::dvec3 Level(int from, int to) const {
    return 1.0 - (rests_[to] - rests_[from]) / (counts_[to] - counts_[from]);
  }

  // Returns the start of each step of the best staircase with `steps` in [1, cells()] steps, the
  // first at 0, followed by the cell where the level 1 begins. Dynamic programming: the best m
  // steps up to a cell are the best m - 1 steps up to an earlier cell and one more step.
  [[nodiscard]] std::vector<int> BestSteps(int steps) const;

 private:
  // Squared error of the best level for the cells [from, to).
  [[nodiscard]] double Error(int from, int to) const {
    const glm::dvec3 rest = rests_[to] - rests_[from];
    return squares_[to] - squares_[from] - glm::dot(rest, rest) / (counts_[to] - counts_[from]);
  }

  // Sums over the cells before [i]: of the weight, of the weighted difference from 1, and of the
  // weighted squared difference from 1.
  std::vector<double> counts_{0.0};
  std::vector<glm::dvec3> rests_{glm::dvec3(0.0)};
  std::vector<double> squares_{0.0};
};

std::vector<int> EdgeResponse::BestSteps(int steps) const {
  const int n = cells();
  // For the best m steps over the first j cells: their error, and the start of the last step.
  std::vector<double> errors(n + 1, 0.0);
  std::vector<std::vector<int>> starts(steps + 1, std::vector<int>(n + 2, 0));
  for (int j = 1; j <= n; ++j) errors[j] = Error(0, j);
  for (int m = 2; m <= steps; ++m) {
    const std::vector<double> before = errors;
    starts[m][n + 1] = n - 1;
    // The response is monotonic. The best start of the last step therefore does not decrease with
    // more steps and does not increase with fewer cells (Knuth 1971), which leaves few starts to
    // try.
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
    if (errors[j] - squares_[j] < errors[end] - squares_[end])
      end = j;  // the level is 1 from here
                // on
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
    // At the edge itself, one side of the kernel is lit, and half of the centre's weight counts.
    const glm::dvec3 weight = i == 0 ? 2.0 * next - 1.0 : next - level;
    kernel.weights.emplace_back(glm::max(weight, 0.0));
    level = next;
    const int before = i == 0 ? 0 : places[i - 1];
    const double aside = std::round(kAside * (places[i] - before) * pixels_per_cell);
    kernel.offsets.emplace_back(places[i] * pixels_per_cell, aside);
  }
  return kernel;
}

// Samples the Gaussian at whole pixels, each for the pixels nearest to it. Then chooses the
// centre's share so that the variance is exact.
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
  // For weights k w_i and a centre of 1 - k sum w_i, the variance is k times sum w_i x_i^2.
  const float scale = std::min(sigma * sigma / variance, 1.0f / side);
  PixelTaps kernel{{glm::vec2(0.0f)}, {glm::vec3(1.0f - scale * side)}};
  for (int i = 1; i <= kGaussianSide; ++i) {
    kernel.offsets.emplace_back(pixels[i], 0.0f);
    kernel.weights.emplace_back(scale * weights[i]);
  }
  return kernel;
}

}  // namespace furrow::render
