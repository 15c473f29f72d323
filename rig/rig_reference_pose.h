// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::character {

// Rotations about the fixed model axes, x first, then y, then z.
[[nodiscard]] glm::quat FromEulerDegrees(const glm::vec3& degrees);

// A frame of a recording as departures from rest, in model axes (see wrinkle::JointDelta).
//
// - `rest`: the frame that counts as rest, on the same skeleton; null: its own rest pose.
// - Joints that do not move (by less than 1e-5 radians and 1e-6 of the skeleton's size) are left
//   out.
// - Errors: kInvalidArgument (poses that do not fit the skeleton), kNonFinite (names the joint).
[[nodiscard]] Result<wrinkle::ReferencePose> ReferencePoseFromFrame(
    std::string name, const wrinkle::PoseFrame& frame, const wrinkle::PoseFrame* rest = nullptr);

struct WeightedPose {
  const wrinkle::ReferencePose* pose = nullptr;
  float weight = 1.0f;
};

// Poses added up in the order given: a joint's rotations, each scaled as a rotation vector, follow
// one another; translations are summed in units of the first pose that states its size.
[[nodiscard]] wrinkle::ReferencePose MixReferencePoses(std::string name,
                                                       std::span<const WeightedPose> parts);

}  // namespace furrow::character
