// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "authoring/paint/uv_raster.h"
#include "character/character.h"

// A picture of 8 bits a channel, as painters fill it.
namespace furrow::character::paint {

// [0, 1], clamped, to the nearest of 256 steps.
[[nodiscard]] inline std::uint8_t ToByte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

// All zero.
[[nodiscard]] inline Picture BlankPicture(const char* name, int width, int height, int channels) {
  Picture picture;
  picture.name = name;
  picture.width = width;
  picture.height = height;
  picture.channels = channels;
  picture.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(channels));
  return picture;
}

// The channels of a texel, which must lie in the picture.
[[nodiscard]] inline std::uint8_t* TexelAt(Picture* picture, int x, int y) {
  const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture->width);
  return &picture->pixels[(row + static_cast<std::size_t>(x)) *
                          static_cast<std::size_t>(picture->channels)];
}

// A square picture, filled texel by texel by `colour(texel)` (a glm::vec4, [0, 1]) and grown by a
// few texels over the borders of its islands.
template <typename Colour>
[[nodiscard]] Picture Fill(const char* name, const std::vector<Texel>& texels, int size,
                           int channels, const Colour& colour) {
  constexpr int kDilation = 6;
  Picture picture = BlankPicture(name, size, size, channels);
  for (const Texel& texel : texels) {
    const glm::vec4 value = colour(texel);
    std::uint8_t* out = TexelAt(&picture, texel.x, texel.y);
    for (int c = 0; c < channels; ++c) out[c] = ToByte(value[c]);
  }
  Dilate(&picture, texels, kDilation);
  return picture;
}

}  // namespace furrow::character::paint
