// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/jitter.h"

#include <cmath>

namespace furrow::render {
namespace {

constexpr float kSamplesPerPixel = 8.0f;

// Number `index` > 0 of the sequence, in (0, 1): the digits of the index, mirrored at the point.
float Halton(int index, int base) {
  float result = 0.0f;
  float digit = 1.0f;
  for (; index > 0; index /= base) {
    digit /= static_cast<float>(base);
    result += digit * static_cast<float>(index % base);
  }
  return result;
}

}  // namespace

glm::vec2 Jitter(int number, float scale) {
  const int length = static_cast<int>(std::ceil(kSamplesPerPixel / (scale * scale)));
  const int index = number % length + 1;
  return {Halton(index, 2) - 0.5f, Halton(index, 3) - 0.5f};
}

}  // namespace furrow::render
