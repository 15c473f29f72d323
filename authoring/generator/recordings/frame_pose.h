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

// The pose of one frame of a recording under way, from rest.
class FramePose {
 public:
  // Both outlive it.
  FramePose(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton);

  // Adds a reference pose of the rig at a strength. Error: kNotFound for the pose or a joint of it.
  [[nodiscard]] Status Apply(const std::string& pose, float weight);
  // An action unit of both sides where the rig has it by side.
  [[nodiscard]] Status ApplyBoth(const std::string& pose, float left, float right);

  // Turns a joint further, about its own axes: degrees, x first, then y, then z.
  void Turn(const std::string& joint, float x, float y, float z);
  // Turns the left joint of a pair, and the right one like its reflection in a mirror.
  void TurnBoth(const std::string& joint, float x, float y, float z);
  void Move(const std::string& joint, const glm::vec3& by);

  // Bends hip and knee so that the ankle comes to `ankle` (model space, metres), or as near as the
  // leg reaches; the foot then has the pitch `heel_up` (degrees) and points `outward` degrees to
  // its own side. `side` +1: left. The hips must be in place.
  void PlantFoot(float side, const glm::vec3& ankle, float heel_up, float outward);

  // Bends all fingers of a hand: 0 relaxed, 1 a fist.
  void CloseHand(float side, float fist);

  // Model space.
  [[nodiscard]] glm::vec3 PlaceOf(const std::string& joint) const;
  [[nodiscard]] std::vector<wrinkle::Transform> Take() { return std::move(frame_); }

 private:
  [[nodiscard]] glm::quat ModelRotation(int joint) const;

  const wrinkle::Rig& rig_;
  const wrinkle::Skeleton& skeleton_;
  std::vector<wrinkle::Transform> frame_;
};

}  // namespace furrow::authoring
