// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// A ball joint in the rest pose, the frame of a sliding mask (thesis 6.2.2). Unit vectors in model
// axes.
struct BallFrame {
  glm::vec3 origin{0.0f};
  glm::vec3 bone{0.0f, -1.0f, 0.0f};  // the direction that counts as straight
  glm::vec3 forward{0.0f, 0.0f, 1.0f};
  glm::vec3 right{-1.0f, 0.0f, 0.0f};  // towards the subject's right
  float length = 1.0f;                 // of the bone below the joint
};

// nullopt if the skeleton lacks a joint or a bone has no length.
[[nodiscard]] std::optional<BallFrame> RestBallFrame(const BallDriver& ball,
                                                     const Skeleton& skeleton);

// The direction that the joint bends to, from the ball driver's values: a unit vector across the
// bone, model axes at rest; zero at rest. The square roots of the values are proportional to the
// cosines of the direction (BallMode::kSmooth).
[[nodiscard]] glm::vec3 BendDirection(const BallFrame& frame, float front, float back, float left,
                                      float right);

// The mask at a point of the rest pose, [0, 1]. It is full in the direction `towards`
// (BendDirection()), fades to 0 at `spread_degrees` to either side, and also fades along the bone
// and away from it. Without a direction it is 0 everywhere. As the joint swings around, the mask
// moves over the surface, whereas fixed masks in four directions would fade into one another.
// shaders/wrinkles/wrinkles_vert.glsl has the same formula.
[[nodiscard]] float SlidingMaskAt(const BallFrame& frame, const Mask& mask,
                                  const glm::vec3& towards, const glm::vec3& point);

}  // namespace furrow::wrinkle
