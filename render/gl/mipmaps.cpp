// SPDX-License-Identifier: Apache-2.0
#include "render/gl/mipmaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/srgb.h"

namespace furrow::render::gl {
namespace {

int Half(int side) { return std::max(side / 2, 1); }

// Calls `write(out, {a, b, c, d})` for each texel of the smaller level, with the offsets of its
// texels and of the four that it averages, in texels.
template <class Write>
void ForEachTexel(int width, int height, const Write& write) {
  const int half_width = Half(width);
  const int half_height = Half(height);
  for (int y = 0; y < half_height; ++y) {
    const auto row = static_cast<std::size_t>(2 * y) * width;
    const std::size_t below = height > 1 ? row + width : row;
    for (int x = 0; x < half_width; ++x) {
      const auto left = static_cast<std::size_t>(2 * x);
      const std::size_t right = width > 1 ? left + 1 : left;
      write(static_cast<std::size_t>(y) * half_width + x,
            std::array<std::size_t, 4>{row + left, row + right, below + left, below + right});
    }
  }
}

const std::array<float, 256>& LinearOfSrgb() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = LinearFromSrgb(static_cast<float>(i) / 255.0f);
    }
    return values;
  }();
  return table;
}

// The inverse, by a table over the square root of the linear value, which is nearly the sRGB value,
// so that dark colours are exact, too.
constexpr int kSrgbSteps = 4096;
std::uint8_t SrgbOfLinear(float linear) {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> values;
    for (int i = 0; i <= kSrgbSteps; ++i) {
      const float root = static_cast<float>(i) / kSrgbSteps;
      values.push_back(
          static_cast<std::uint8_t>(std::lround(255.0f * SrgbFromLinear(root * root))));
    }
    return values;
  }();
  return table[static_cast<std::size_t>(std::lround(std::sqrt(linear) * kSrgbSteps))];
}

// `format` and `type` of `texels`, as OpenGL names them.
void UploadLevel(const MipTarget& target, int level, int width, int height, GLenum format,
                 GLenum type, const void* texels) {
  if (target.layer < 0) {
    glTextureSubImage2D(target.texture, level, 0, 0, width, height, format, type, texels);
  } else {
    glTextureSubImage3D(target.texture, level, 0, 0, target.layer, width, height, 1, format, type,
                        texels);
  }
}

template <class Texels, class Smaller>
void UploadLevels(const MipTarget& target, Texels texels, GLenum format, GLenum type,
                  const Smaller& smaller) {
  int width = target.width;
  int height = target.height;
  for (int level = 0;; ++level) {
    UploadLevel(target, level, width, height, format, type, texels.data());
    if (width == 1 && height == 1) return;
    texels = smaller(texels, width, height);
    width = Half(width);
    height = Half(height);
  }
}

}  // namespace

std::vector<std::uint8_t> HalfSize(const std::vector<std::uint8_t>& texels, int width, int height,
                                   MipSpace space) {
  std::vector<std::uint8_t> half(static_cast<std::size_t>(Half(width)) * Half(height) * 4);
  const std::array<float, 256>& linear = LinearOfSrgb();
  ForEachTexel(width, height, [&](std::size_t out, const std::array<std::size_t, 4>& in) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const auto value = [&](std::size_t i) { return texels[in[i] * 4 + channel]; };
      std::uint8_t& mean = half[out * 4 + channel];
      if (space == MipSpace::kSrgb && channel < 3) {
        mean = SrgbOfLinear(
            0.25f * (linear[value(0)] + linear[value(1)] + linear[value(2)] + linear[value(3)]));
      } else {
        mean = static_cast<std::uint8_t>((value(0) + value(1) + value(2) + value(3) + 2) / 4);
      }
    }
  });
  return half;
}

std::vector<float> HalfSize(const std::vector<float>& texels, int width, int height, int channels) {
  const auto stride = static_cast<std::size_t>(channels);
  std::vector<float> half(static_cast<std::size_t>(Half(width)) * Half(height) * stride);
  ForEachTexel(width, height, [&](std::size_t out, const std::array<std::size_t, 4>& in) {
    for (std::size_t channel = 0; channel < stride; ++channel) {
      const auto value = [&](std::size_t i) { return texels[in[i] * stride + channel]; };
      half[out * stride + channel] = 0.25f * (value(0) + value(1) + value(2) + value(3));
    }
  });
  return half;
}

void UploadWithMips(const MipTarget& target, std::vector<std::uint8_t> texels, MipSpace space) {
  UploadLevels(target, std::move(texels), GL_RGBA, GL_UNSIGNED_BYTE,
               [space](const std::vector<std::uint8_t>& level, int width, int height) {
                 return HalfSize(level, width, height, space);
               });
}

void UploadWithMips(const MipTarget& target, std::vector<float> texels, int channels) {
  UploadLevels(target, std::move(texels), channels == 1 ? GL_RED : GL_RGBA, GL_FLOAT,
               [channels](const std::vector<float>& level, int width, int height) {
                 return HalfSize(level, width, height, channels);
               });
}

}  // namespace furrow::render::gl
