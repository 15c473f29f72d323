// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Builds the pose of one frame of a recording, starting from rest.
class FramePose {
 public:
  // Both arguments must outlive the pose.
  FramePose(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton);

  // Adds a reference pose of the rig at a strength. Error: kNotFound (the pose or one of its
  // joints).
  [[nodiscard]] Status Apply(const std::string& pose, float weight);
  // Adds an action unit that the rig defines separately for the left and right side.
  [[nodiscard]] Status ApplyBoth(const std::string& pose, float left, float right);

  // Rotates a joint about its own axes, in addition to earlier rotations: degrees, x first, then y,
  // then z.
  void Turn(const std::string& joint, float x, float y, float z);
  // Rotates the left joint of a pair, and the right joint symmetrically.
  void TurnBoth(const std::string& joint, float x, float y, float z);
  void Move(const std::string& joint, const glm::vec3& by);

  // Bends hip and knee so that the ankle reaches `ankle` (model space, metres), or as near as the
  // leg allows. The foot then has the pitch `heel_up` and points outward by `outward`, both in
  // degrees. `side`: +1 is left. Precondition: the hips are in place.
  void PlantFoot(float side, const glm::vec3& ankle, float heel_up, float outward);

  // Bends all fingers of a hand: 0 relaxed, 1 a fist.
  void CloseHand(float side, float fist);

  // The position of a joint, model space.
  [[nodiscard]] glm::vec3 PlaceOf(const std::string& joint) const;
  [[nodiscard]] std::vector<wrinkle::Transform> Take() { return std::move(frame_); }

 private:
  [[nodiscard]] glm::quat ModelRotation(int joint) const;

  const wrinkle::Rig& rig_;
  const wrinkle::Skeleton& skeleton_;
  std::vector<wrinkle::Transform> frame_;
};

}  // namespace furrow::authoring
