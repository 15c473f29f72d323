// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/render/reference/float_picture.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

namespace furrow::render::test {

PictureError Compare(const FloatPicture& picture, const FloatPicture& reference, int margin) {
  PictureError error;
  for (int y = margin; y < reference.height - margin; ++y) {
    for (int x = margin; x < reference.width - margin; ++x) {
      const glm::vec4& expected = reference.At(x, y);
      if (expected.a <= 0.5f) continue;
      const glm::dvec3 difference = glm::abs(glm::dvec3(picture.At(x, y)) - glm::dvec3(expected));
      error.rmse += difference * difference;
      error.worst = glm::max(error.worst, difference);
      ++error.texels;
    }
  }
  error.rmse = glm::sqrt(error.rmse / static_cast<double>(std::max<std::size_t>(error.texels, 1)));
  return error;
}

}  // namespace furrow::render::test
