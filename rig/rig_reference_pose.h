// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::rig {

// Converts rotations about the fixed model axes, applied in the order x, y, z.
[[nodiscard]] glm::quat FromEulerDegrees(const glm::vec3& degrees);

// The anchor of each joint that pose drivers measure: joint -> anchor.
using PoseAnchors = std::map<std::string, std::string, std::less<>>;

// Converts a frame of a recording to departures from rest, in model axes (see wrinkle::JointDelta).
//
// - `rest`: the rest pose, a frame on the same skeleton; null: the skeleton's own rest pose.
// - Each joint is compared with itself at rest, in its own axes. The performer's place, heading and
//   posture therefore do not enter the pose of a face, neither in the frame nor in `rest`.
// - In flat skeletons, joints of the face move with the head without hanging from it. A joint of
//   `anchors` that has gone with its anchor to `rest`, and not with its own parent, is compared in
//   the anchor's space.
// - Joints that move by less than 1e-5 radians and by less than 1e-6 of the skeleton's size are
//   omitted.
// - Blend shapes: the coefficient, less that of `rest`. Those below 0.001 are omitted, and so are
//   the angles of head and eyes (wrinkle::IsTrackerAngle()), which belong to no expression.
// - Errors: kInvalidArgument (a pose does not fit its skeleton or names), kNonFinite (names the
//   joint or the blend shape).
[[nodiscard]] Result<wrinkle::ReferencePose> ReferencePoseFromFrame(
    std::string name, const wrinkle::PoseFrame& frame, const wrinkle::PoseFrame* rest = nullptr,
    const PoseAnchors& anchors = {});

struct WeightedPose {
  const wrinkle::ReferencePose* pose = nullptr;
  float weight = 1.0f;
};

// Adds poses in the given order. Rotations are scaled as rotation vectors and applied one after the
// other. Translations are summed in the units of the first pose that states its size. Those of
// poses without a size are summed apart (JointDelta::unscaled_translation), because they are in
// units of the skeleton to which the rig will be bound. Coefficients of blend shapes are scaled and
// summed.
[[nodiscard]] wrinkle::ReferencePose MixReferencePoses(std::string name,
                                                       std::span<const WeightedPose> parts);

}  // namespace furrow::rig
