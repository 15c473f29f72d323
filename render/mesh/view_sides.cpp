// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/view_sides.h"

#include <glm/matrix.hpp>

namespace furrow::render {

// A point is inside if low * w <= x and x <= high * w, for y too. This holds before the division by
// w, and so also for triangles that reach behind the camera.
ViewSides::ViewSides(const glm::mat4& view_projection, std::span<const glm::mat4> model,
                     const glm::vec2& low, const glm::vec2& high) {
  planes_.reserve(model.size());
  for (const glm::mat4& joint : model) {
    const glm::mat4 rows = glm::transpose(view_projection * joint);
    planes_.push_back({rows[0] - low.x * rows[3], high.x * rows[3] - rows[0],
                       rows[1] - low.y * rows[3], high.y * rows[3] - rows[1]});
  }
}

}  // namespace furrow::render
