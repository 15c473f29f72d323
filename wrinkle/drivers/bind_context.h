// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/joint_chain.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

// What the driver kinds share while a rig is bound: looking up joints, poses and blend shapes, and
// what to do where something is missing (BindOptions::allow_missing). Private to wrinkle/.
class BindContext {
 public:
  BindContext(const Rig& rig, const Skeleton& skeleton,
              std::span<const std::string> blend_shape_names, const BindOptions& options,
              JointChains* chains);

  // The rig's anchor and its reference poses as poses of this skeleton. To be called first.
  [[nodiscard]] Status ResolveAnchorAndPoses();

  // The joint, or kNoJoint where it is missing and may be.
  // `whose` is "driver 'x'", `field` its field.
  [[nodiscard]] Result<int> Joint(std::string_view whose, std::string_view field,
                                  const std::string& name);
  // Index of the blend shape, matched without case; -1 where it is missing and may be. It may where
  // a rig reads joints, too, and the stream has no blend shapes at all.
  [[nodiscard]] Result<int> BlendShape(std::string_view whose, const std::string& name);
  // A driver that makes no sense on this skeleton (a bone without length): an error, or where
  // things may be missing a warning and Ok, and the driver rests at 0.
  [[nodiscard]] Status Unusable(std::string_view whose, std::string_view why);
  void Warn(std::string warning) { warnings_.push_back(std::move(warning)); }

  [[nodiscard]] const Skeleton& skeleton() const { return skeleton_; }
  [[nodiscard]] JointChains& chains() { return *chains_; }
  [[nodiscard]] float size() const { return size_; }  // SkeletonSize()
  [[nodiscard]] int anchor() const { return anchor_; }
  [[nodiscard]] bool anchor_missing() const { return anchor_missing_; }
  // Pose of the skeleton in reference pose `name`; null when the rig has none of that name.
  [[nodiscard]] const std::vector<Transform>* ReferenceLocals(std::string_view name) const;

  [[nodiscard]] std::vector<std::string>& missing_joints() { return missing_joints_; }
  [[nodiscard]] std::vector<std::string>& missing_blend_shapes() { return missing_blend_shapes_; }
  [[nodiscard]] std::vector<std::string>& warnings() { return warnings_; }

 private:
  [[nodiscard]] Status ApplyReferencePose(const ReferencePose& pose,
                                          std::vector<Transform>* locals);

  const Rig& rig_;
  const Skeleton& skeleton_;
  std::span<const std::string> blend_shape_names_;
  BindOptions options_;
  JointChains* chains_;
  float size_ = 0.0f;
  int anchor_ = kNoJoint;
  bool anchor_missing_ = false;
  std::vector<std::vector<Transform>> reference_locals_;  // as rig_.reference_poses
  std::vector<std::string> missing_joints_;
  std::vector<std::string> missing_blend_shapes_;
  std::vector<std::string> warnings_;
};

inline constexpr float kLeastLength = 1e-12f;  // shorter vectors have no direction

// `v` as a unit vector; zero where it has no length.
[[nodiscard]] glm::vec3 Direction(const glm::vec3& v);

// A direction given in model axes in the rest pose, seen from `joint` (kNoJoint: unchanged).
[[nodiscard]] glm::vec3 ToJointAxes(const Skeleton& skeleton, int joint,
                                    const glm::vec3& direction);

}  // namespace furrow::wrinkle
