// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/status.h"
#include "render/request/image.h"

namespace furrow::render {

enum class ImageFormat { kJpeg, kPng };

// Encodes `image` as a file. `quality` in [1, 100] applies to JPEG only; chroma is subsampled 4:2:0
// below 90 and kept (4:4:4) from 90 on. Errors: kInvalidArgument (an empty image, a pixel count
// that does not match its size, or a quality out of range), kInternal (TurboJPEG failed).
[[nodiscard]] Result<std::vector<std::uint8_t>> EncodeImage(const Image& image, ImageFormat format,
                                                            int quality = 85);

}  // namespace furrow::render
