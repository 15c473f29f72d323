// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

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

}  // namespace furrow::character::paint
