// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/sliding_mask.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/scalar.h"
#include "wrinkle/drivers/ball/ball_fields.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/skeleton/direction.h"

namespace furrow::wrinkle {
namespace {

// The shares of the mask's length and radius over which it fades. The shader has the same values.
constexpr float kSoftEnd = 0.4f;
constexpr float kSoftRim = 0.4f;

// What a frame depends on besides the fields of the driver.
struct FrameContext {
  const std::string& name;  // of the driver
  const Feed& feed;
  const Skeleton& skeleton;
};

// The joint of a driver and the bone below it. An empty `end` means the joint's tail.
std::optional<SlidingFrame> FrameAt(const std::string& joint_name, const std::string& end_name,
                                    const Skeleton& skeleton) {
  const int joint = skeleton.Find(joint_name);
  const int end = end_name.empty() ? joint : skeleton.Find(end_name);
  if (joint == kNoJoint || end == kNoJoint) return std::nullopt;
  SlidingFrame frame;
  frame.origin = RestOrigin(skeleton, joint);
  const glm::vec3 tail(skeleton.rest_model()[joint] * glm::vec4(skeleton.tails()[joint], 1.0f));
  frame.length = glm::length((end_name.empty() ? tail : RestOrigin(skeleton, end)) - frame.origin);
  return frame.length > 0.0f ? std::optional(frame) : std::nullopt;
}

// The direction from the origin of `parent` to `to`; zero if the skeleton has no such joint.
glm::vec3 UpperBone(const std::string& parent, const glm::vec3& to, const Skeleton& skeleton) {
  const int joint = skeleton.Find(parent);
  return joint == kNoJoint ? glm::vec3(0.0f) : Direction(to - RestOrigin(skeleton, joint));
}

// Sets the axes of a frame; nullopt if one of them has no direction.
std::optional<SlidingFrame> WithAxes(SlidingFrame frame, const glm::vec3& bone,
                                     const glm::vec3& forward, const glm::vec3& right) {
  const glm::vec3 none(0.0f);
  if (bone == none || forward == none) return std::nullopt;
  frame.bone = bone;
  frame.forward = forward;
  frame.right = right;
  return frame;
}

std::optional<SlidingFrame> FrameOf(const BallDriver& ball, const FrameContext& context) {
  const auto frame = FrameAt(ball.joint, ball.end, context.skeleton);
  if (!frame || context.skeleton.Find(ball.parent) == kNoJoint) return std::nullopt;
  const glm::vec3 bone = ball.bone == glm::vec3(0.0f)
                             ? UpperBone(ball.parent, frame->origin, context.skeleton)
                             : Direction(ball.bone);
  const glm::vec3 forward = AcrossBone(ball.forward, bone);
  return WithAxes(*frame, bone, forward, SubjectsRight(bone, forward));
}

std::optional<SlidingFrame> FrameOf(const HingeDriver& hinge, const FrameContext& context) {
  const auto frame = FrameAt(hinge.joint, hinge.end, context.skeleton);
  if (!frame || !hinge.axis || context.skeleton.Find(hinge.parent) == kNoJoint) return std::nullopt;
  const glm::vec3 bone = hinge.bone ? Direction(*hinge.bone)
                                    : UpperBone(hinge.parent, frame->origin, context.skeleton);
  const glm::vec3 axis = AcrossBone(*hinge.axis, bone);
  auto result = WithAxes(*frame, bone, Direction(glm::cross(axis, bone)), axis);
  if (!result) return result;
  const auto reads = [&](const char* value) {
    return std::ranges::any_of(context.feed.sources, [&](const Feed::Source& source) {
      return source.driver == context.name && source.value == value;
    });
  };
  const bool extends = reads("extended") && !reads("flexed");
  result->values = extends ? std::array{-1, 1, -1, -1} : std::array{0, -1, -1, -1};
  return result;
}

std::optional<SlidingFrame> FrameOf(const TwistDriver& twist, const FrameContext& context) {
  const auto frame = FrameAt(twist.joint, {}, context.skeleton);
  if (!frame) return std::nullopt;
  const int joint = context.skeleton.Find(twist.joint);
  const glm::vec3 own =
      context.skeleton.rest_model_rotations()[joint] * context.skeleton.tails()[joint];
  const glm::vec3 bone = Direction(twist.axis.value_or(own));
  glm::vec3 forward = AcrossBone({0.0f, 0.0f, 1.0f}, bone);
  if (forward == glm::vec3(0.0f)) forward = AcrossBone({0.0f, 1.0f, 0.0f}, bone);
  // A positive angle, "twist_left", turns `forward` towards cross(bone, forward).
  auto result = WithAxes(*frame, bone, forward, -glm::cross(bone, forward));
  if (result) result->values = {-1, -1, 0, 1};
  return result;
}

template <class Kind>
std::optional<SlidingFrame> FrameOf(const Kind&, const FrameContext&) {
  return std::nullopt;
}

}  // namespace

std::optional<SlidingFrame> RestSlidingFrame(const Driver& driver, const Feed& feed,
                                             const Skeleton& skeleton) {
  return VisitFields(driver, [&](const auto& fields) {
    return FrameOf(fields, {.name = driver.name, .feed = feed, .skeleton = skeleton});
  });
}

glm::vec3 BendDirection(const SlidingFrame& frame, std::span<const float> values) {
  const auto root = [&](std::size_t side) {
    const int value = frame.values[side];
    return value < 0 ? 0.0f : std::sqrt(values[static_cast<std::size_t>(value)]);
  };
  const float forward = root(0) - root(1);
  const float aside = root(3) - root(2);
  return Direction(forward * frame.forward + aside * frame.right);
}

float SlidingMaskAt(const SlidingFrame& frame, const Mask& mask, const glm::vec3& towards,
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
