// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

namespace furrow::character {

// A decoded picture: 8 bits, 16 bits or a float per channel, rows from the top. The user of the
// picture decides whether values are sRGB (Material::base_colour_texture) or linear. Colours are
// not premultiplied by alpha. Exactly one of the three lists holds the pixels.
struct Picture {
  std::string name;
  int width = 0;
  int height = 0;
  int channels = 4;  // 1 to 4, interleaved
  // width * height * channels values in one of these lists:
  std::vector<std::uint8_t> pixels;     // 255 means 1
  std::vector<std::uint16_t> pixels16;  // 65535 means 1
  std::vector<float> pixels_float;      // finite, any range (EXR)
};

// A picture whose file is not decoded: a name without pixels.
[[nodiscard]] inline Picture Undecoded(std::string name) {
  return {.name = std::move(name), .pixels = {}, .pixels16 = {}};
}

// Halves the sides, by averaging texels as they are stored, until the longer one has at most
// `max_side` texels. Pictures of 16 bits and floats stay as they are.
void Reduce(int max_side, Picture* picture);

// Returns one channel (from 0) of the texel at a UV, in [0, 1]; 0 if the picture has no such
// channel. (0, 0) is the top left corner. A coordinate of 1 is the last texel; coordinates outside
// [0, 1] repeat the picture. Precondition: the picture has pixels.
[[nodiscard]] float ChannelAt(const Picture& picture, const glm::vec2& uv, int channel);

// Limits for untrusted files. 16384 is the largest texture side of common GPUs; 64 Mi pixels take
// at most 512 MiB with four channels of 16 bits.
inline constexpr int kMaxPictureSide = 16384;
inline constexpr std::int64_t kMaxPicturePixels = 64ll << 20;

}  // namespace furrow::character
