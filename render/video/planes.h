// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/status.h"
#include "render/request/image.h"

namespace furrow::render {

// A picture as video encoders take it: brightness at full resolution, colour differences at half of
// it (4:2:0). BT.601, as in JPEG, in the limited range (Y: 16 to 235, U and V: 16 to 240;
// video_full_range_flag 0 of ITU-T H.264, annex E), because Firefox takes every video for that.
// Rows from the top, without padding.
struct Planes {
  int width = 0;  // pixels, even
  int height = 0;
  std::vector<std::uint8_t> y;  // width * height bytes
  std::vector<std::uint8_t> u;  // a quarter of that; v too
  std::vector<std::uint8_t> v;
};

// Converts `image` and reuses the memory of `planes`. An odd width or height becomes even by
// repeating the last column or row. Errors: kInvalidArgument (an empty image, or pixels that do not
// match its size), kInternal (TurboJPEG failed).
[[nodiscard]] Status ToPlanes(const Image& image, Planes* planes);

}  // namespace furrow::render
