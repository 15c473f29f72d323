// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "authoring/paint/dilate.h"
#include "authoring/paint/surface_texels.h"
#include "character/character.h"

// Functions that create and fill pictures with 8 bits per channel.
namespace furrow::authoring {

// Converts a number in [0, 1] to a byte in [0, 255], clamped and rounded.
[[nodiscard]] inline std::uint8_t ToByte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

// A picture of 8 bits per channel, all zero.
[[nodiscard]] inline character::Picture BlankPicture(const char* name, int width, int height,
                                                     int channels) {
  character::Picture picture;
  picture.name = name;
  picture.width = width;
  picture.height = height;
  picture.channels = channels;
  picture.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(channels));
  return picture;
}

// The channels of a texel. Precondition: the texel is in the picture.
[[nodiscard]] inline std::uint8_t* TexelAt(character::Picture* picture, int x, int y) {
  const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture->width);
  return &picture->pixels[(row + static_cast<std::size_t>(x)) *
                          static_cast<std::size_t>(picture->channels)];
}

// Writes the first channels of `colour`, each in [0, 1], to a texel. Precondition: the texel is in
// the picture, which has at most 4 channels.
inline void SetTexel(character::Picture* picture, int x, int y, const glm::vec4& colour) {
  std::uint8_t* out = TexelAt(picture, x, y);
  for (int c = 0; c < picture->channels; ++c) out[c] = ToByte(colour[c]);
}

// A picture of `size` x `size` texels, with `colour(texel)`, a glm::vec4 in [0, 1], at each of
// `texels`. The colours continue 6 texels beyond the UV islands, which hides seams.
template <typename Colour>
[[nodiscard]] character::Picture FillPicture(const char* name,
                                             const std::vector<SurfaceTexel>& texels, int size,
                                             int channels, const Colour& colour) {
  constexpr int kDilation = 6;
  character::Picture picture = BlankPicture(name, size, size, channels);
  for (const SurfaceTexel& texel : texels) {
    SetTexel(&picture, texel.x, texel.y, colour(texel));
  }
  Dilate(&picture, texels, kDilation);
  return picture;
}

}  // namespace furrow::authoring
