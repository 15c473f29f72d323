// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/picture_fit.h"

#include <algorithm>

#include "authoring/paint/canvas.h"

namespace furrow::authoring {
namespace {

using character::Picture;

std::uint8_t ByteAt(const Picture& picture, std::size_t index) {
  if (!picture.pixels.empty()) return picture.pixels[index];
  if (!picture.pixels16.empty()) return static_cast<std::uint8_t>(picture.pixels16[index] / 257);
  return ToByte(picture.pixels_float[index]);
}

Picture ToColourBytes(const Picture& from) {
  const bool grey = from.channels < 3;
  const bool alpha = from.channels % 2 == 0;
  Picture to = BlankPicture(from.name.c_str(), from.width, from.height, alpha ? 4 : 3);
  const auto channels = static_cast<std::size_t>(from.channels);
  const auto count = static_cast<std::size_t>(from.width) * static_cast<std::size_t>(from.height);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(to.channels); ++c) {
      const std::size_t source = c == 3 ? channels - 1 : grey ? 0 : c;
      to.pixels[i * static_cast<std::size_t>(to.channels) + c] =
          ByteAt(from, i * channels + source);
    }
  }
  return to;
}

// Half of the width and height; an odd last row or column is dropped.
Picture Halve(const Picture& from) {
  const int width = std::max(from.width / 2, 1), height = std::max(from.height / 2, 1);
  Picture to = BlankPicture(from.name.c_str(), width, height, from.channels);
  const auto channels = static_cast<std::size_t>(from.channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int sum[4] = {0, 0, 0, 0}, plain[4] = {0, 0, 0, 0};
      int weights = 0;
      for (int k = 0; k < 4; ++k) {
        const int column = std::min(2 * x + (k & 1), from.width - 1);
        const int row = std::min(2 * y + (k >> 1), from.height - 1);
        const std::uint8_t* texel =
            &from.pixels[(static_cast<std::size_t>(row) * static_cast<std::size_t>(from.width) +
                          static_cast<std::size_t>(column)) *
                         channels];
        const int weight = from.channels == 4 ? texel[3] : 1;
        weights += weight;
        for (std::size_t c = 0; c < channels; ++c) {
          sum[c] += weight * texel[c];
          plain[c] += texel[c];
        }
      }
      std::uint8_t* out = TexelAt(&to, x, y);
      for (std::size_t c = 0; c < channels; ++c) {
        const bool mean = c == 3 || weights == 0;
        out[c] =
            static_cast<std::uint8_t>(mean ? (plain[c] + 2) / 4 : (sum[c] + weights / 2) / weights);
      }
    }
  }
  return to;
}

}  // namespace

Picture FitPicture(const Picture& picture, int size) {
  Picture fitted = ToColourBytes(picture);
  while (std::max(fitted.width, fitted.height) > std::max(size, 1)) fitted = Halve(fitted);
  return fitted;
}

}  // namespace furrow::authoring
