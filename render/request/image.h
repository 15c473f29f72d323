// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace furrow::render {

// A finished picture: 8-bit sRGB, three bytes per pixel, rows from the top, no padding.
struct Image {
  int width = 0;  // pixels; 0: no picture
  int height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height bytes
  std::uint64_t token = 0;        // FrameRequest::token
  // Of the width and height. Below 100, the picture is enlarged, with the help of former pictures if
  // there are any.
  int drawn_percent = 100;
};

}  // namespace furrow::render
