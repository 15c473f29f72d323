// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture.h"

#include <algorithm>
#include <cmath>

namespace furrow::character {

float ChannelAt(const Picture& picture, const glm::vec2& uv, int channel) {
  if (channel >= picture.channels) return 0.0f;
  const auto place = [](float t, int size) {
    // Repeats outside [0, 1], which is glTF's default. 1 itself is the last texel.
    const float wrapped = t >= 0.0f && t <= 1.0f ? t : t - std::floor(t);
    return std::min(static_cast<int>(wrapped * static_cast<float>(size)), size - 1);
  };
  const std::size_t index = (static_cast<std::size_t>(place(uv.y, picture.height)) *
                                 static_cast<std::size_t>(picture.width) +
                             static_cast<std::size_t>(place(uv.x, picture.width))) *
                                static_cast<std::size_t>(picture.channels) +
                            static_cast<std::size_t>(channel);
  if (!picture.pixels_float.empty()) return std::clamp(picture.pixels_float[index], 0.0f, 1.0f);
  if (!picture.pixels16.empty()) return static_cast<float>(picture.pixels16[index]) / 65535.0f;
  return static_cast<float>(picture.pixels[index]) / 255.0f;
}

}  // namespace furrow::character
