// SPDX-License-Identifier: Apache-2.0
// Pictures of avatars: every accepted one has as many finite texels as its size says.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "character/pictures/picture_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::character;
  const auto picture = DecodePicture("fuzz", {data, size});
  if (!picture.ok()) {
    // Without the codec, nothing is tested.
    if (picture.status().code() == furrow::StatusCode::kUnavailable) std::abort();
    return 0;
  }
  const std::size_t values =
      std::size_t(picture->width) * std::size_t(picture->height) * std::size_t(picture->channels);
  const std::size_t have =
      picture->pixels.size() + picture->pixels16.size() + picture->pixels_float.size();
  if (picture->width < 1 || picture->height < 1 || picture->channels < 1 || picture->channels > 4 ||
      have != values) {
    std::abort();
  }
  for (const float value : picture->pixels_float) {
    if (!std::isfinite(value)) std::abort();
  }
  return 0;
}
