// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// Points fixed to joints, each in the space of a base joint. Drivers measure these points.
//
// A point is carried along the joints between its own joint and the base, never through the root. A
// character kilometres from the origin therefore loses no precision, and a motion of the whole
// character changes no bit of any point.
class JointChains {
 public:
  // Adds a point at `offset` in the space of `joint`, to be measured in the space of `base`
  // (kNoJoint: model space). Returns its index.
  int Add(const Skeleton& skeleton, int joint, const glm::vec3& offset, int base);

  // A point's way: the joints up to the ancestor shared with the base, then the joints down to it.
  struct Chain {
    glm::vec3 offset{0.0f};
    std::span<const std::int16_t> up;
    std::span<const std::int16_t> down;
  };
  [[nodiscard]] Chain chain(int point) const {
    const Point& p = points_[point];
    const std::span<const std::int16_t> joints(joints_);
    return {p.offset, joints.subspan(p.first, p.num_up),
            joints.subspan(p.first + p.num_up, p.num_down)};
  }

  // The position of point `point` in its base's space. `local` is the skeleton's pose.
  [[nodiscard]] glm::vec3 Evaluate(std::span<const Transform> local, int point) const;
  [[nodiscard]] glm::dvec3 Evaluate(std::span<const PreciseTransform> local, int point) const;

 private:
  struct Point {
    glm::vec3 offset{0.0f};
    std::uint32_t first = 0;   // into joints_: `num_up` joints up to the shared
    std::uint16_t num_up = 0;  // ancestor, then `num_down` joints to the base
    std::uint16_t num_down = 0;
  };
  std::vector<Point> points_;
  std::vector<std::int16_t> joints_;
};

}  // namespace furrow::wrinkle
