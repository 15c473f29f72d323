// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// A ball joint in the rest pose, model axes: where a sliding mask lies (thesis 6.2.2). Unit axes.
struct BallFrame {
  glm::vec3 origin{0.0f};
  glm::vec3 bone{0.0f, -1.0f, 0.0f};  // the direction that counts as straight
  glm::vec3 forward{0.0f, 0.0f, 1.0f};
  glm::vec3 right{-1.0f, 0.0f, 0.0f};  // towards the subject's right
  float length = 1.0f;                 // of the bone below the joint
};

// None where the skeleton lacks a joint or a bone has no length.
[[nodiscard]] std::optional<BallFrame> RestBallFrame(const BallDriver& ball,
                                                     const Skeleton& skeleton);

// Where the joint bends to: unit, across the bone, model axes at rest; zero at rest. From the
// driver's values: their roots are the cosines of the direction (ball.h).
[[nodiscard]] glm::vec3 BendDirection(const BallFrame& frame, float front, float back, float left,
                                      float right);

// The mask at a point of the rest pose, [0, 1]: full in the middle of the side that `towards`
// (BendDirection()) points to, 0 from `spread_degrees` to either side of it on, and fading out
// along the bone and away from it; 0 everywhere without a direction. As the joint swings round, it
// moves over the surface, where fixed masks in four directions fade into one another. Mirrored in
// shaders/common_wrinkles_vert.glsl.
[[nodiscard]] float SlidingMaskAt(const BallFrame& frame, const Mask& mask,
                                  const glm::vec3& towards, const glm::vec3& point);

}  // namespace furrow::wrinkle
