// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace furrow::render::test {

// Linear values, rows from the bottom, as in OpenGL.
struct FloatPicture {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> texels;

  FloatPicture() = default;
  FloatPicture(int w, int h, const glm::vec4& fill = glm::vec4(0.0f))
      : width(w),
        height(h),
        texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

  [[nodiscard]] glm::vec4& At(int x, int y) { return texels[Index(x, y)]; }
  [[nodiscard]] const glm::vec4& At(int x, int y) const { return texels[Index(x, y)]; }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

// The difference of a picture from its reference, per channel.
struct PictureError {
  glm::dvec3 rmse{0.0};
  glm::dvec3 worst{0.0};
  std::size_t texels = 0;
};

// Compares the texels of `[margin, size - margin)` where the reference's alpha is above 0.5.
[[nodiscard]] PictureError Compare(const FloatPicture& picture, const FloatPicture& reference,
                                   int margin);

}  // namespace furrow::render::test
