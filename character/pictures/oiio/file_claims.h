// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::character {

// Checks of what a small file claims to be, before a decoder allocates memory for it.

// True if every attribute in the headers of an OpenEXR file ends inside the file. OpenEXR allocates
// the size that an attribute states before it reads it, so 400 bytes could claim 2 GiB.
//
// `bytes`: a whole file with the magic number. Layout: OpenEXR's "File Layout", version 2: a
// header is a list of name, type (zero-terminated), size (int32) and value, and ends with an empty
// name. Files with several parts have several headers, and an empty one at the end.
[[nodiscard]] inline bool ExrHeadersFit(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kMultiPart = 0x10;  // in the second byte of the version field
  if (bytes.size() < 8) return false;
  const bool has_parts = (bytes[5] & kMultiPart) != 0;
  bytes = bytes.subspan(8);
  // Skips a zero-terminated text. False: it does not end.
  const auto skip_text = [&bytes](bool* empty) {
    const auto end = std::ranges::find(bytes, std::uint8_t{0});
    if (end == bytes.end()) return false;
    *empty = end == bytes.begin();
    bytes = bytes.subspan(static_cast<std::size_t>(end - bytes.begin()) + 1);
    return true;
  };
  for (bool is_first = true, empty = false;; is_first = empty) {
    if (!skip_text(&empty)) return false;
    if (empty) {
      if (!has_parts || is_first) return true;
      continue;
    }
    bool has_no_type = false;
    if (!skip_text(&has_no_type) || bytes.size() < 4) return false;
    const std::uint32_t size = bytes[0] | std::uint32_t{bytes[1]} << 8 |
                               std::uint32_t{bytes[2]} << 16 | std::uint32_t{bytes[3]} << 24;
    bytes = bytes.subspan(4);
    if (size > bytes.size()) return false;
    bytes = bytes.subspan(size);
  }
}

// True if a PNG file is long enough for the pixels that its header states: deflate makes data at
// most 1032 times smaller (zlib's technical details), so others are cut off. `bytes`: a whole file
// with the magic number. The chunk IHDR comes first: width, height (big-endian), bits per sample
// and the colour type.
[[nodiscard]] inline bool PngPixelsFit(std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t kLargestRatio = 1032;
  constexpr std::uint64_t kSlack = 1024;  // bytes; what is left of the smallest pictures
  if (bytes.size() < 26) return false;
  const auto number = [&bytes](std::size_t at) {
    return std::uint64_t{bytes[at]} << 24 | std::uint64_t{bytes[at + 1]} << 16 |
           std::uint64_t{bytes[at + 2]} << 8 | bytes[at + 3];
  };
  constexpr std::array<std::uint64_t, 7> kSamples = {1, 0, 3, 1, 2, 0, 4};  // by colour type
  const std::uint8_t colour_type = bytes[25];
  if (colour_type >= kSamples.size()) return false;
  const std::uint64_t bits_per_pixel = kSamples[colour_type] * bytes[24];
  // The decoder checks the sides; here they only must not overflow.
  const std::uint64_t row_bytes = number(16) * bits_per_pixel / 8;
  const std::uint64_t rows = number(20);
  return rows == 0 || row_bytes <= (bytes.size() + kSlack) * kLargestRatio / rows;
}

}  // namespace furrow::character
