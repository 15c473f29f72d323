// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "base/status.h"

namespace furrow::character {

// A decoded picture: 8 or 16 bits or a float a channel, rows from the top, linear unless the use
// says sRGB. Alpha is not multiplied into the colours. One of the three lists holds the pixels.
struct Picture {
  std::string name;
  int width = 0;
  int height = 0;
  int channels = 4;
  std::vector<std::uint8_t> pixels;     // width * height * channels, when 8 bits
  std::vector<std::uint16_t> pixels16;  // the same, when 16 bits
  std::vector<float> pixels_float;      // the same, from an EXR: finite, of any range
};

// One channel of the texel at a UV (v down), [0, 1]; 0 where the picture has no such channel. UVs
// within [0, 1] mean the picture itself, 1 its last texel; others repeat it.
[[nodiscard]] float ChannelAt(const Picture& picture, const glm::vec2& uv, int channel);

inline constexpr int kMaxPictureSide = 16384;
inline constexpr std::int64_t kMaxPicturePixels = 64ll << 20;  // decoded: at most 512 MiB

// A PNG, JPEG or OpenEXR in memory, decoded with the channels it has (1 to 4); the format is told
// by its first bytes. Sizes are checked before anything is allocated. Errors: kUnsupported (another
// format, more channels), kLimit (too large), kParse (damaged), kNonFinite (an EXR's texel).
[[nodiscard]] Result<Picture> DecodePicture(std::string name, std::span<const std::uint8_t> bytes);

// A picture file; `where` of an error is the path. Its name is `name`.
[[nodiscard]] Result<Picture> LoadPicture(std::string name, const std::filesystem::path& path);

// As PNG: equal pictures give equal bytes. Errors: kInvalidArgument (pixels do not fit the size),
// kUnsupported (floats, which only an EXR holds).
[[nodiscard]] Result<std::string> EncodePng(const Picture& picture);

// As OpenEXR with half floats (11 bits of precision, +-65504). Integers are written as [0, 1].
// Errors: kInvalidArgument (pixels do not fit the size).
[[nodiscard]] Result<std::string> EncodeExr(const Picture& picture);

}  // namespace furrow::character
