// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/sliding_mask.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/scalar.h"
#include "wrinkle/drivers/ball/ball_fields.h"
#include "wrinkle/skeleton/direction.h"

namespace furrow::wrinkle {
namespace {

// The shares of the mask's length and radius over which it fades. The shader has the same values.
constexpr float kSoftEnd = 0.4f;
constexpr float kSoftRim = 0.4f;

glm::vec3 RestOrigin(const Skeleton& skeleton, int joint) {
  return glm::vec3(skeleton.rest_model()[joint][3]);
}

}  // namespace

std::optional<BallFrame> RestBallFrame(const BallDriver& ball, const Skeleton& skeleton) {
  const int parent = skeleton.Find(ball.parent);
  const int joint = skeleton.Find(ball.joint);
  const int end = ball.end.empty() ? joint : skeleton.Find(ball.end);
  if (parent == kNoJoint || joint == kNoJoint || end == kNoJoint) return std::nullopt;
  BallFrame frame;
  frame.origin = RestOrigin(skeleton, joint);
  const glm::vec3 tail(skeleton.rest_model()[joint] * glm::vec4(skeleton.tails()[joint], 1.0f));
  frame.length = glm::length((ball.end.empty() ? tail : RestOrigin(skeleton, end)) - frame.origin);
  frame.bone = Direction(ball.bone == glm::vec3(0.0f) ? frame.origin - RestOrigin(skeleton, parent)
                                                      : ball.bone);
  const glm::vec3 forward = Direction(ball.forward);
  frame.forward = Direction(forward - glm::dot(forward, frame.bone) * frame.bone);
  const glm::vec3 none(0.0f);
  if (!(frame.length > 0.0f) || frame.bone == none || frame.forward == none) return std::nullopt;
  frame.right = SubjectsRight(frame.bone, frame.forward);
  return frame;
}

glm::vec3 BendDirection(const BallFrame& frame, float front, float back, float left, float right) {
  const float forward = std::sqrt(front) - std::sqrt(back);
  const float aside = std::sqrt(right) - std::sqrt(left);
  return Direction(forward * frame.forward + aside * frame.right);
}

float SlidingMaskAt(const BallFrame& frame, const Mask& mask, const glm::vec3& towards,
                    const glm::vec3& point) {
  if (towards == glm::vec3(0.0f)) return 0.0f;
  // In bone lengths, so that one rig fits characters of any size.
  const glm::vec3 offset = (point - frame.origin) / frame.length;
  const float along = glm::dot(offset, frame.bone);
  const glm::vec3 across = offset - along * frame.bone;
  const float distance = glm::length(across);
  // Points on the bone have no side: they count as 90 degrees from `towards`.
  const float cosine = distance > 1e-6f ? glm::dot(across, towards) / distance : 0.0f;
  const float edge = std::cos(glm::radians(mask.spread_degrees));
  const float soft = kSoftEnd * (mask.above + mask.below);
  return Smoothstep(edge, 1.0f, cosine) * Smoothstep(-mask.above, soft - mask.above, along) *
         (1.0f - Smoothstep(mask.below - soft, mask.below, along)) *
         (1.0f - Smoothstep((1.0f - kSoftRim) * mask.radius, mask.radius, distance));
}

}  // namespace furrow::wrinkle
