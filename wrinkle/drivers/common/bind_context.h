// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wrinkle/drivers/common/bind_options.h"
#include "wrinkle/skeleton/direction.h"
#include "wrinkle/skeleton/joint_chain.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

// The parts of a rig that drivers refer to while they are bound.
struct BindSource {
  std::string anchor;  // the rig's; empty if it has none or no driver measures from it
  const SizeReference* size_reference = nullptr;  // the rig's; may be null
  std::span<const ReferencePose> reference_poses;
  bool reads_joints = false;  // some driver reads joints
  std::span<const std::string> blend_shape_names;
};

// Binding state that all driver kinds share: looks up joints, poses and blend shapes, and handles
// missing ones (BindOptions::allow_missing). Private to wrinkle/.
class BindContext {
 public:
  // The arguments outlive the context. `skeleton` is turned by `options.turn`. `chains` receives
  // the drivers' points.
  BindContext(const BindSource& source, const Skeleton& skeleton, const BindOptions& options,
              JointChains* chains);

  // Finds the anchor and applies the reference poses to the skeleton. Call it before any Bind().
  [[nodiscard]] Status ResolveAnchorAndPoses();

  // The index of a joint; kNoJoint if it is missing and BindOptions allow that. `owner` and `field`
  // describe the reference in errors: "driver 'x'", "joint".
  [[nodiscard]] Result<int> Joint(std::string_view owner, std::string_view field,
                                  const std::string& name);
  // The indices of the joints that do the part of a rig's joint: its chain (BindOptions), or the
  // joint itself. Empty if the joint is missing and may be.
  [[nodiscard]] Result<std::vector<int>> JointChain(std::string_view owner, std::string_view field,
                                                    const std::string& name);
  // The index of a blend shape, matched without case. -1 if it is missing, and BindOptions allow
  // that, or some driver reads joints and the stream has no blend shapes at all. Otherwise a
  // missing one is kNotFound.
  [[nodiscard]] Result<int> BlendShape(std::string_view owner, const std::string& name);
  // Reports a driver that cannot work on this skeleton, for example a bone without length: an
  // error, or Ok and a warning if BindOptions allow missing joints. The driver then rests at 0.
  [[nodiscard]] Status Unusable(std::string_view owner, std::string_view why);
  void Warn(std::string warning) { warnings_.push_back(std::move(warning)); }

  // Rests in Furrow's model space; see BindOptions::turn.
  [[nodiscard]] const Skeleton& skeleton() const { return skeleton_; }
  // Converts from Furrow's model space to that of poses, which are not turned. Only measures that
  // include a root joint need it: whatever is measured between joints is the same in both.
  [[nodiscard]] glm::vec3 ToPoseSpace(const glm::vec3& v) const {
    return turned_ ? glm::conjugate(options_.turn) * v : v;
  }
  [[nodiscard]] glm::dvec3 ToPoseSpace(const glm::dvec3& v) const {
    return turned_ ? glm::conjugate(glm::dquat(options_.turn)) * v : v;
  }
  // The local rest rotation of `joint` in the skeleton that poses belong to.
  [[nodiscard]] glm::quat RestRotationInPose(int joint) const;
  [[nodiscard]] JointChains& chains() { return *chains_; }
  [[nodiscard]] const JointChains& chains() const { return *chains_; }
  [[nodiscard]] float size() const { return size_; }  // SkeletonSizeBy()
  [[nodiscard]] int anchor() const { return anchor_; }
  [[nodiscard]] bool anchor_missing() const { return anchor_missing_; }
  // The skeleton's local transforms in the rest pose.
  [[nodiscard]] std::span<const PreciseTransform> rest_locals() const { return rest_locals_; }
  // The skeleton's local transforms in reference pose `name`; null if the rig has no such pose.
  [[nodiscard]] const std::vector<PreciseTransform>* ReferenceLocals(std::string_view name) const;
  // The coefficient of a blend shape in reference pose `name`; 0 if the rig has no such pose.
  [[nodiscard]] float ReferenceShape(std::string_view name, std::string_view blend_shape) const;

  [[nodiscard]] std::vector<std::string>& missing_joints() { return missing_joints_; }
  [[nodiscard]] std::vector<std::string>& missing_blend_shapes() { return missing_blend_shapes_; }
  [[nodiscard]] std::vector<std::string>& warnings() { return warnings_; }

 private:
  [[nodiscard]] Status ApplyPose(const ReferencePose& pose, std::vector<PreciseTransform>* locals);

  const BindSource& source_;
  const Skeleton& skeleton_;
  BindOptions options_;
  bool turned_ = false;  // options_.turn is not the identity
  JointChains* chains_;
  float size_ = 0.0f;
  int anchor_ = kNoJoint;
  bool anchor_missing_ = false;
  std::vector<PreciseTransform> rest_locals_;
  std::vector<std::vector<PreciseTransform>> reference_locals_;  // one per reference pose
  std::vector<std::string> missing_joints_;
  std::vector<std::string> missing_blend_shapes_;
  std::vector<std::string> warnings_;
};

}  // namespace furrow::wrinkle
