// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// Points fixed to joints, each seen from a base joint: what drivers measure.
//
// A point is carried along the joints between its own and the base alone, never through the root.
// So a character that walks kilometres from the origin loses no precision, and a motion of the
// whole character leaves every point unchanged to the last bit.
class JointChains {
 public:
  // A point at `offset` (joint's space) of `joint`, seen from `base` (kNoJoint: model space).
  // Returns its index.
  int Add(const Skeleton& skeleton, int joint, const glm::vec3& offset, int base);

  // What a point is carried along: joints up to the one shared with the base, then down to it.
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

  // Where point `point` is, in its base's space. `local` is the skeleton's pose.
  [[nodiscard]] glm::vec3 Evaluate(std::span<const Transform> local, int point) const;

 private:
  struct Point {
    glm::vec3 offset{0.0f};
    std::uint32_t first = 0;   // into joints_: first those up to the shared ancestor, then
    std::uint16_t num_up = 0;  // those down to the base
    std::uint16_t num_down = 0;
  };
  std::vector<Point> points_;
  std::vector<std::int16_t> joints_;
};

}  // namespace furrow::wrinkle
