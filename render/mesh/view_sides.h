// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace furrow::render {

// The four sides of a rectangle of a picture, as planes in the space of each joint of a posed
// character: dot(plane, (point, 1)) is below 0 for points beyond that side. A surface is outside
// the rectangle if all its points are beyond one of them.
class ViewSides {
 public:
  // `view_projection`: model space to clip space; `model`: joint matrices in model space; `low` and
  // `high`: corners in normalised device coordinates, where the picture is [-1, 1].
  ViewSides(const glm::mat4& view_projection, std::span<const glm::mat4> model,
            const glm::vec2& low, const glm::vec2& high);

  using Planes = std::array<glm::vec4, 4>;
  [[nodiscard]] const Planes& of(int joint) const {
    return planes_[static_cast<std::size_t>(joint)];
  }

 private:
  std::vector<Planes> planes_;  // by joint
};

}  // namespace furrow::render
