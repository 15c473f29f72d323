// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace furrow::render {

// Pixels [x0, x1) x [y0, y1). Rows count from the bottom, as in OpenGL.
struct ScreenRect {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;

  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  // The smallest rectangle that contains both.
  [[nodiscard]] ScreenRect With(const ScreenRect& other) const {
    if (empty()) return other;
    if (other.empty()) return *this;
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1),
            std::max(y1, other.y1)};
  }
  // Extends each side by `margin` pixels, clamped to the picture.
  [[nodiscard]] ScreenRect Grown(int margin, int width, int height) const {
    return {std::max(x0 - margin, 0), std::max(y0 - margin, 0), std::min(x1 + margin, width),
            std::min(y1 + margin, height)};
  }
};

}  // namespace furrow::render
