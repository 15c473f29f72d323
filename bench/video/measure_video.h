// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/status.h"
#include "render/request/image.h"

namespace furrow::bench {

// One way to encode the pictures of a scene.
struct Encoded {
  double mbit_s = 0.0;        // at 30 pictures per second, key pictures included
  double later_mbit_s = 0.0;  // without the first second
  double psnr_db = 0.0;       // of the brightness, from the mean squared error of all pictures
  double cpu_ms = 0.0;        // processor time per picture, conversion included
};

// JPEG as the daemon encodes it.
[[nodiscard]] Result<Encoded> MeasureJpeg(const std::vector<render::Image>& images, int quality);
// H.264 as the daemon encodes it, without a limit of bits.
[[nodiscard]] Result<Encoded> MeasureVideo(const std::vector<render::Image>& images, int quality);

// H.264 of the same PSNR, between the two nearest of some qualities: interpolated in the logarithm
// of the rate. Error: kNotFound, if no quality is good enough.
[[nodiscard]] Result<Encoded> VideoAt(const std::vector<render::Image>& images, double psnr_db);

}  // namespace furrow::bench
