// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

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

void Reduce(int max_side, Picture* picture) {
  int step = 1;
  while (std::max(picture->width, picture->height) > max_side * step) step *= 2;
  if (step == 1 || picture->pixels.empty()) return;
  const int width = std::max(picture->width / step, 1);
  const int height = std::max(picture->height / step, 1);
  const auto channels = static_cast<std::size_t>(picture->channels);
  const auto row = static_cast<std::size_t>(picture->width) * channels;
  std::vector<std::uint8_t> reduced;
  reduced.reserve(static_cast<std::size_t>(width) * height * channels);
  for (int y = 0; y < height; ++y) {
    // A side shorter than a step is averaged as a whole.
    const int rows = std::min(step, picture->height);
    for (int x = 0; x < width; ++x) {
      const int columns = std::min(step, picture->width);
      for (std::size_t channel = 0; channel < channels; ++channel) {
        std::size_t sum = 0;
        for (int i = 0; i < rows; ++i) {
          const std::uint8_t* const from =
              &picture->pixels[static_cast<std::size_t>(y * step + i) * row +
                               static_cast<std::size_t>(x * step) * channels];
          for (int j = 0; j < columns; ++j)
            sum += from[static_cast<std::size_t>(j) * channels + channel];
        }
        const auto count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
        reduced.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
      }
    }
  }
  picture->width = width;
  picture->height = height;
  picture->pixels = std::move(reduced);
}

}  // namespace furrow::character
