// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/rest_detector.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtx/component_wise.hpp>

namespace furrow::server {
namespace {

constexpr float kRotation = 2e-4f;       // per quaternion component; about 0.02 degrees
constexpr float kTranslation = 2e-4f;    // absolute, and relative to the length
constexpr float kValue = 0.5f / 255.0f;  // half a step of an 8-bit weight

bool IsNear(const wrinkle::Transform& a, const wrinkle::Transform& b) {
  // q and -q are the same rotation.
  const bool opposite = glm::dot(a.rotation, b.rotation) < 0.0f;
  const glm::quat turn = a.rotation - (opposite ? -b.rotation : b.rotation);
  const float rotation = std::max(std::max(std::fabs(turn.x), std::fabs(turn.y)),
                                  std::max(std::fabs(turn.z), std::fabs(turn.w)));
  const glm::vec3 moved = glm::abs(a.translation - b.translation);
  const glm::vec3 scaled = glm::abs(a.scale - b.scale);
  return rotation <= kRotation &&
         glm::compMax(moved - kTranslation * glm::abs(b.translation)) <= kTranslation &&
         glm::compMax(scaled) <= kTranslation;
}

bool IsNear(float a, float b) { return std::fabs(a - b) <= kValue; }

}  // namespace

void RestDetector::Update(const wrinkle::LocalPose& pose, std::span<const float> wrinkle_weights,
                          Time now) {
  const std::size_t shapes = pose.blend_shapes.size();
  const auto near = [](const auto& a, const auto& b) { return IsNear(a, b); };
  // The size differs after a new skeleton or rig, which counts as movement.
  const bool rests =
      values_.size() == shapes + wrinkle_weights.size() &&
      std::ranges::equal(pose.joints, joints_, near) &&
      std::ranges::equal(pose.blend_shapes, std::span(values_).first(shapes), near) &&
      std::ranges::equal(wrinkle_weights, std::span(values_).subspan(shapes), near);
  // The reference stays the pose of the last movement. Replacing it each time would let slow drift
  // pass.
  if (rests && moved_at_ != Time{0}) return;
  joints_ = pose.joints;
  values_ = pose.blend_shapes;
  values_.insert(values_.end(), wrinkle_weights.begin(), wrinkle_weights.end());
  moved_at_ = now;
}

}  // namespace furrow::server
