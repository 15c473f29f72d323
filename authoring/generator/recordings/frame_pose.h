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

  // Adds a reference pose of the rig. `weight`: 0 adds nothing, 1 the full pose. Errors: kNotFound
  // (the rig lacks the pose, or the skeleton a joint; joints before it have moved).
  [[nodiscard]] Status Apply(const std::string& pose, float weight);
  // Adds the reference poses "<pose>_l" and "<pose>_r" with the weights `left` and `right`, or, if
  // the rig has no pose for the left side, the pose `pose` with the weight `left`. Errors: those of
  // Apply().
  [[nodiscard]] Status ApplyBoth(const std::string& pose, float left, float right);

  // Rotates a joint about its local axes, after earlier rotations: by `x` degrees about x, then `y`
  // about y, then `z` about z. Turn(), TurnBoth() and Move() ignore unknown joints.
  void Turn(const std::string& joint, float x, float y, float z);
  // Rotates "<joint>_l" as Turn() does, and "<joint>_r" as its mirror image.
  void TurnBoth(const std::string& joint, float x, float y, float z);
  // Moves a joint by `by` metres, in the axes of its parent.
  void Move(const std::string& joint, const glm::vec3& by);

  // Bends hip and knee so that the ankle reaches `ankle` (model space, metres), or as near as the
  // leg allows. The foot then has the pitch `heel_up` and points outward by `outward`, both in
  // degrees. `side`: +1 left, -1 right. Call it after the hips have been moved.
  void PlantFoot(float side, const glm::vec3& ankle, float heel_up, float outward);

  // Bends all fingers of a hand. `side`: +1 left, -1 right. `fist`: 0 relaxed to 1 a fist.
  void CloseHand(float side, float fist);

  // The position of a joint, model space, metres; the origin for an unknown joint.
  [[nodiscard]] glm::vec3 PlaceOf(const std::string& joint) const;
  // Moves out the local transforms, one per joint. The object must not be used afterwards.
  [[nodiscard]] std::vector<wrinkle::Transform> Take() { return std::move(frame_); }

 private:
  [[nodiscard]] glm::quat ModelRotation(int joint) const;

  const wrinkle::Rig& rig_;
  const wrinkle::Skeleton& skeleton_;
  std::vector<wrinkle::Transform> frame_;
};

}  // namespace furrow::authoring
