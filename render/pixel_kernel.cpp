// SPDX-License-Identifier: Apache-2.0
#include "render/pixel_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/subsurface_kernel.h"

namespace furrow::render {
namespace {

// A tap that is worth less than this in every channel is not taken.
constexpr float kLeastWeight = 5e-4f;
constexpr float kLeastSigma = 1.0f / 3.0f;  // pixels
constexpr int kGaussianSide = 3;            // taps of a Gaussian on one side

std::vector<int> WholePixels(const std::vector<KernelTap>& kernel, float pixels_per_mm) {
  std::vector<int> pixels{0};
  for (std::size_t i = 2; i < kernel.size(); i += 2) {  // the right one of each pair
    const int nearest = static_cast<int>(std::lround(kernel[i].offset * pixels_per_mm));
    pixels.push_back(std::max(nearest, pixels.back() + 1));
  }
  return pixels;
}

}  // namespace

std::vector<glm::vec4> PixelKernel(const SkinProfile& profile, int taps, float pixels_per_mm) {
  const std::vector<int> pixels = WholePixels(SeparableKernel(profile, taps), pixels_per_mm);
  std::vector<glm::vec4> kernel;
  glm::vec3 inside(0.5f);  // of the line profile, from minus infinity to the tap's inner border
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const bool last = i + 1 == pixels.size();
    const float border = last ? 0.0f : 0.5f * static_cast<float>(pixels[i] + pixels[i + 1]);
    const glm::vec3 share = last ? glm::vec3(1.0f) : StepResponse(profile, border / pixels_per_mm);
    const glm::vec3 rest = glm::vec3(1.0f) - inside;
    const bool negligible = std::max({rest.r, rest.g, rest.b}) < kLeastWeight;
    if (i > 0 && negligible) break;
    const glm::vec3 weight = i == 0 ? 2.0f * (share - inside) : share - inside;
    kernel.emplace_back(weight, static_cast<float>(pixels[i]));
    inside = share;
  }
  // What was not worth a tap stays with the outermost one.
  const glm::vec3 rest = glm::vec3(1.0f) - inside;
  kernel.back() += glm::vec4(kernel.size() == 1 ? 2.0f * rest : rest, 0.0f);
  return kernel;
}

// Samples of the Gaussian at whole pixels, each for the pixels that lie nearest to it, and then the
// centre's share chosen so that the variance is exact.
std::vector<glm::vec4> PixelGaussian(float sigma) {
  if (sigma < kLeastSigma) return {{1.0f, 1.0f, 1.0f, 0.0f}};
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
  std::vector<glm::vec4> kernel{glm::vec4(glm::vec3(1.0f - scale * side), 0.0f)};
  for (int i = 1; i <= kGaussianSide; ++i) {
    kernel.emplace_back(glm::vec3(scale * weights[i]), static_cast<float>(pixels[i]));
  }
  return kernel;
}

}  // namespace furrow::render
