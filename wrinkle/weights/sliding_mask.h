// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// The joint of a driver in the rest pose, the frame of a sliding mask (thesis 6.2.2). Unit vectors
// in model axes.
struct SlidingFrame {
  glm::vec3 origin{0.0f};
  glm::vec3 bone{0.0f, -1.0f, 0.0f};  // the direction that counts as straight, or the twist's axis
  glm::vec3 forward{0.0f, 0.0f, 1.0f};
  glm::vec3 right{-1.0f, 0.0f, 0.0f};
  float length = 1.0f;  // of the bone below the joint
  // Which of the driver's values point forward, back, left and right; -1: none.
  std::array<int, 4> values{0, 1, 2, 3};
};

// The frame of a mask that `driver` moves, for the wrinkle map that `feed` raises.
//
// - Ball: forward and right as in the driver, and its four values.
// - Hinge with an axis: forward is the side that it flexes to. The mask lies there. If `feed` reads
//   the hinge's "extended" and not its "flexed", it lies on the opposite side.
// - Twist: the mask lies on the side to which the front of the joint turns (its top, if the axis
//   points to the front). That is the subject's left for "twist_left" about an axis that points up.
// - nullopt for other drivers, if the skeleton lacks a joint, or if a bone has no length.
[[nodiscard]] std::optional<SlidingFrame> RestSlidingFrame(const Driver& driver, const Feed& feed,
                                                           const Skeleton& skeleton);

// The direction that the joint moves to: a unit vector across the bone, model axes at rest; zero at
// rest. `values`: all values of the driver. Their square roots are proportional to the cosines of
// the direction (BallMode::kSmooth).
[[nodiscard]] glm::vec3 BendDirection(const SlidingFrame& frame, std::span<const float> values);

// The mask at a point of the rest pose, [0, 1]. It is full in the direction `towards`
// (BendDirection()), fades to 0 at `spread_degrees` to either side, and also fades along the bone
// and away from it. Without a direction it is 0 everywhere. As a ball joint swings around, the mask
// moves over the surface, whereas fixed masks in four directions would fade into one another.
// shaders/wrinkles/wrinkles_vert.glsl has the same formula.
[[nodiscard]] float SlidingMaskAt(const SlidingFrame& frame, const Mask& mask,
                                  const glm::vec3& towards, const glm::vec3& point);

}  // namespace furrow::wrinkle
