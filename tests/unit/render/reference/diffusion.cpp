// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/render/reference/diffusion.h"

#include <algorithm>
#include <cmath>

namespace furrow::render::test {
namespace {

// Per texel: light, and in w the share of skin that it came from.
using Field = std::vector<glm::dvec4>;

// The shares of a Gaussian of `sigma` (pixels) in the pixels 0, 1, 2, ... away from its centre.
std::vector<double> PixelShares(double sigma) {
  const auto cumulative = [&](double x) { return 0.5 * std::erfc(-x / (sigma * std::sqrt(2.0))); };
  std::vector<double> shares;
  for (int i = 0; i <= static_cast<int>(std::ceil(6.0 * sigma)) + 1; ++i) {
    shares.push_back(cumulative(i + 0.5) - cumulative(i - 0.5));
  }
  return shares;
}

// Convolves `lines` lines of `length` texels. Texels are `step` apart in memory, lines `stride`.
void ConvolveLines(const std::vector<double>& shares, int lines, int stride, int length, int step,
                   Field* field) {
  const int reach = static_cast<int>(shares.size()) - 1;
  Field line(static_cast<std::size_t>(length));
  for (int l = 0; l < lines; ++l) {
    for (int i = 0; i < length; ++i) {
      glm::dvec4 sum(0.0);
      const int last = std::min(length - 1, i + reach);
      for (int j = std::max(0, i - reach); j <= last; ++j) {
        sum += shares[static_cast<std::size_t>(std::abs(i - j))] *
               (*field)[static_cast<std::size_t>(l * stride + j * step)];
      }
      line[static_cast<std::size_t>(i)] = sum;
    }
    for (int i = 0; i < length; ++i) {
      (*field)[static_cast<std::size_t>(l * stride + i * step)] = line[static_cast<std::size_t>(i)];
    }
  }
}

bool IsSkin(const glm::vec4& texel) { return texel.a > 0.5f; }

}  // namespace

FloatPicture Diffuse(const SkinProfile& profile, const FloatPicture& irradiance,
                     double mm_per_pixel) {
  const int width = irradiance.width;
  const int height = irradiance.height;
  std::vector<glm::dvec3> light(irradiance.texels.size());
  std::vector<glm::dvec3> skin(irradiance.texels.size());
  for (const SkinGaussian& gaussian : profile) {
    Field field;
    for (const glm::vec4& texel : irradiance.texels) {
      field.push_back(IsSkin(texel) ? glm::dvec4(glm::dvec3(texel), 1.0) : glm::dvec4(0.0));
    }
    const std::vector<double> shares =
        PixelShares(std::sqrt(static_cast<double>(gaussian.variance)) / mm_per_pixel);
    ConvolveLines(shares, height, width, width, 1, &field);
    ConvolveLines(shares, width, 1, height, width, &field);
    for (std::size_t i = 0; i < field.size(); ++i) {
      light[i] += glm::dvec3(gaussian.weight) * glm::dvec3(field[i]);
      skin[i] += glm::dvec3(gaussian.weight) * field[i].w;
    }
  }
  FloatPicture result(width, height);
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (IsSkin(irradiance.texels[i])) {
      result.texels[i] = glm::vec4(glm::vec3(light[i] / skin[i]), 1.0f);
    }
  }
  return result;
}

glm::dvec3 DiffuseBySum(const SkinProfile& profile, const FloatPicture& irradiance,
                        double mm_per_pixel, int x, int y, int subdivisions) {
  glm::dvec3 light(0.0);
  glm::dvec3 skin(0.0);
  for (int j = 0; j < irradiance.height * subdivisions; ++j) {
    for (int i = 0; i < irradiance.width * subdivisions; ++i) {
      const glm::vec4& texel = irradiance.At(i / subdivisions, j / subdivisions);
      if (!IsSkin(texel)) continue;
      const double dx = ((i + 0.5) / subdivisions - (x + 0.5)) * mm_per_pixel;
      const double dy = ((j + 0.5) / subdivisions - (y + 0.5)) * mm_per_pixel;
      const glm::dvec3 share(RadialProfile(profile, std::hypot(dx, dy)));
      light += share * glm::dvec3(texel);
      skin += share;
    }
  }
  return light / skin;
}

}  // namespace furrow::render::test
