// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "render/settings/settings.h"

namespace furrow::render {

// What a picture costs, estimated from its request before anything is drawn.
struct PictureCost {
  std::size_t texture_bytes = 0;  // of the textures that it is drawn into, an upper bound
  double work = 0.0;              // in pixels that are shaded once
};

// `width`, `height`: pixels. `samples`: per pixel, >= 1, if the settings leave it to the device.
[[nodiscard]] PictureCost EstimateCost(const Settings& settings, int width, int height,
                                       int samples = 1);

}  // namespace furrow::render
