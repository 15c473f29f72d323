// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace furrow::character {

// A decoded picture: 8 bits, 16 bits or a float per channel, rows from the top. Values are linear
// unless the use says sRGB; colours are not premultiplied by alpha. Exactly one of the three lists
// holds the pixels.
struct Picture {
  std::string name;
  int width = 0;
  int height = 0;
  int channels = 4;
  std::vector<std::uint8_t> pixels;     // width * height * channels values
  std::vector<std::uint16_t> pixels16;  // as many values
  std::vector<float> pixels_float;      // as many values, finite, any range (EXR)
};

// One channel, in [0, 1], of the texel at a UV (v down); 0 if the picture has no such channel. A
// coordinate of 1 is the last texel; coordinates outside [0, 1] repeat the picture.
[[nodiscard]] float ChannelAt(const Picture& picture, const glm::vec2& uv, int channel);

inline constexpr int kMaxPictureSide = 16384;
inline constexpr std::int64_t kMaxPicturePixels = 64ll << 20;  // at most 512 MiB decoded

}  // namespace furrow::character
