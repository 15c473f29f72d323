// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/derivative_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace furrow::render {
namespace {

// Fills a map of the picture's size from a function of (x, y).
template <class Function>
DerivativeMap MapTexels(const character::Picture& picture, const Function& function) {
  DerivativeMap map{picture.width, picture.height, {}};
  map.texels.reserve(static_cast<std::size_t>(map.width) * map.height * 2);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const glm::vec2 derivative = function(x, y);
      map.texels.push_back(derivative.x);
      map.texels.push_back(derivative.y);
    }
  }
  return map;
}

// Clamps to the edge. Resampling does not wrap around, unlike the sampler.
glm::vec2 At(const DerivativeMap& map, int x, int y) {
  x = std::clamp(x, 0, map.width - 1);
  y = std::clamp(y, 0, map.height - 1);
  const std::size_t index = 2 * (static_cast<std::size_t>(y) * map.width + x);
  return {map.texels[index], map.texels[index + 1]};
}

// Of a picture of 8 bits with three or four channels.
std::vector<std::uint8_t> WithAlpha(const character::Picture& picture) {
  if (picture.channels == 4) return picture.pixels;
  const std::size_t count = picture.pixels.size() / 3;
  std::vector<std::uint8_t> rgba(4 * count, 255);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(&picture.pixels[3 * i], 3, &rgba[4 * i]);
  }
  return rgba;
}

}  // namespace

float Texel(const character::Picture& picture, int x, int y, int channel) {
  if (channel >= picture.channels) return channel == 3 ? 1.0f : 0.0f;
  const std::size_t index =
      (static_cast<std::size_t>(y) * picture.width + x) * picture.channels + channel;
  if (!picture.pixels_float.empty()) return picture.pixels_float[index];
  if (!picture.pixels16.empty()) return picture.pixels16[index] / 65535.0f;
  return picture.pixels[index] / 255.0f;
}

DerivativeMap DerivativesFromNormalMap(const character::Picture& picture) {
  // A normal map from a file may hold normals that lie in or below the surface. Slopes stay finite
  // and within the range of half floats.
  const auto slope_of = [](float x, float y, float z) {
    const float over_z = 1.0f / std::max(2.0f * z - 1.0f, 1e-3f);
    return glm::clamp(glm::vec2((2.0f * x - 1.0f) * over_z, (2.0f * y - 1.0f) * over_z),
                      -kMaxDerivative, kMaxDerivative);
  };
  if (picture.channels == 3 && !picture.pixels16.empty()) {  // of our own files
    const std::uint16_t* from = picture.pixels16.data();
    return MapTexels(picture, [&](int, int) {
      const glm::vec2 slope = slope_of(from[0] / 65535.0f, from[1] / 65535.0f, from[2] / 65535.0f);
      from += 3;
      return slope;
    });
  }
  return MapTexels(picture, [&](int x, int y) {
    return slope_of(Texel(picture, x, y, 0), Texel(picture, x, y, 1), Texel(picture, x, y, 2));
  });
}

DerivativeMap DerivativesFromDerivativeMap(const character::Picture& picture, float scale) {
  const bool floats = !picture.pixels_float.empty();
  const float gain = floats ? 1.0f : 2.0f * scale;
  const float offset = floats ? 0.0f : -scale;
  return MapTexels(picture, [&](int x, int y) {
    const glm::vec2 stored(Texel(picture, x, y, 0), Texel(picture, x, y, 1));
    return glm::clamp(gain * stored + offset, -kMaxDerivative, kMaxDerivative);
  });
}

// Mip levels average all four channels. The difference between the mean square and the square of
// the mean is the roughness that the averaging hides (LEAN mapping, Olano and Baker 2010).
std::vector<float> WithMoments(const DerivativeMap& map) {
  std::vector<float> texels(map.texels.size() * 2);
  for (std::size_t i = 0; i < map.texels.size(); i += 2) {
    const float x = map.texels[i];
    const float y = map.texels[i + 1];
    float* const to = &texels[2 * i];
    to[0] = x;
    to[1] = y;
    to[2] = x * x;
    to[3] = y * y;
  }
  return texels;
}

DerivativeMap Resample(const DerivativeMap& map, int width, int height) {
  if (map.width == width && map.height == height) return map;
  DerivativeMap result{width, height, {}};
  result.texels.reserve(static_cast<std::size_t>(width) * height * 2);
  for (int y = 0; y < height; ++y) {
    // Texel centres are at halves.
    const float source_y = (y + 0.5f) * map.height / height - 0.5f;
    const int y0 = static_cast<int>(std::floor(source_y));
    for (int x = 0; x < width; ++x) {
      const float source_x = (x + 0.5f) * map.width / width - 0.5f;
      const int x0 = static_cast<int>(std::floor(source_x));
      const float fx = source_x - x0;
      const glm::vec2 upper = glm::mix(At(map, x0, y0), At(map, x0 + 1, y0), fx);
      const glm::vec2 lower = glm::mix(At(map, x0, y0 + 1), At(map, x0 + 1, y0 + 1), fx);
      const glm::vec2 value = glm::mix(upper, lower, source_y - y0);
      result.texels.push_back(value.x);
      result.texels.push_back(value.y);
    }
  }
  return result;
}

std::vector<std::uint8_t> ToRgba8(const character::Picture& picture) {
  const bool grey = picture.channels < 3;  // grey, or grey and alpha
  if (!grey && !picture.pixels.empty()) return WithAlpha(picture);
  std::vector<std::uint8_t> rgba;
  rgba.reserve(static_cast<std::size_t>(picture.width) * picture.height * 4);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int channel = 0; channel < 4; ++channel) {
        int source = channel;
        if (grey) source = channel < 3 ? 0 : (picture.channels == 2 ? 1 : 3);
        const float value = std::clamp(Texel(picture, x, y, source), 0.0f, 1.0f);
        rgba.push_back(static_cast<std::uint8_t>(value * 255.0f + 0.5f));
      }
    }
  }
  return rgba;
}

}  // namespace furrow::render
