// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// True for the names of angles that Live Link Face sends among its blend shapes, in radians:
// "HeadYaw", "LeftEyePitch". Case is ignored.
[[nodiscard]] bool IsTrackerAngle(std::string_view name);

// Turns a character's head by the values HeadYaw, HeadPitch and HeadRoll that Live Link Face sends
// among its blend shapes, in radians. Created once per stream, then run once per pose.
//
// Positive values turn the face to the subject's left, raise the chin and lower the right ear.
// Source of the signs: a recording of the app in which the eyes stay on the phone, and so turn
// against the head. The names of the eyes' angles (LeftEyeYaw, ...) are not used, because the blend
// shapes eyeLook... say the same.
class HeadTurn {
 public:
  HeadTurn() = default;  // turns nothing

  // `roles`: of the skeleton's joints; empty: the joints named "head" and "neck". The neck takes
  // 40% of the turn, shared by all its joints, and the head the rest. `blend_shapes`: the stream's
  // names, in its order, matched without case.
  [[nodiscard]] static HeadTurn Create(const Skeleton& skeleton, const JointRoles& roles,
                                       std::span<const std::string> blend_shapes);

  // True if the stream has no such value or the skeleton no head.
  [[nodiscard]] bool empty() const { return joints_.empty(); }

  // Turns the joints of `local`, which has num_joints of the skeleton. Missing coefficients count
  // as 0; angles are limited to 1.5 radians. Does not allocate, and changes nothing on failure.
  [[nodiscard]] JobStatus Run(std::span<const float> coefficients,
                              std::span<Transform> local) const;

 private:
  struct Joint {
    int joint = kNoJoint;
    float share = 0.0f;
    glm::quat to_parent{1.0f, 0.0f, 0.0f, 0.0f};  // from model axes to the parent's, at rest
  };
  std::array<int, 3> angles_{-1, -1, -1};  // blend shapes of yaw, pitch and roll; -1: none
  std::vector<Joint> joints_;
  std::size_t num_joints_ = 0;
};

}  // namespace furrow::wrinkle
