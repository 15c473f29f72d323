// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "wrinkle/skeleton/direction.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

// A joint and its two bones at rest, as unit directions in model axes.
struct Limb {
  int joint = kNoJoint;
  glm::vec3 upper{0.0f};
  glm::vec3 lower{0.0f};
};

// Builds the pose that raises one value of a driver to 1 (rig/full_pose.h). Driver kinds use it in
// their FullPose(). The arguments outlive the builder.
class FullPoseBuilder {
 public:
  // `degrees`: the angle of a hinge, a ball or a twist, [0, 180]; none: the angle that gives 1.
  FullPoseBuilder(std::string_view driver, std::string_view value, const Skeleton& skeleton,
                  std::span<const ReferencePose> reference_poses,
                  std::optional<float> degrees = std::nullopt)
      : driver_(driver),
        value_(value),
        skeleton_(skeleton),
        reference_poses_(reference_poses),
        degrees_(degrees) {}

  [[nodiscard]] std::string_view value() const { return value_; }
  [[nodiscard]] std::optional<float> degrees() const { return degrees_; }
  [[nodiscard]] const Skeleton& skeleton() const { return skeleton_; }

  // The rig's reference pose of that name. Error: kNotFound.
  [[nodiscard]] Result<ReferencePose> FromRig(const std::string& name) const;
  // The rest pose under the name "<driver>.<value>", to be filled in.
  [[nodiscard]] ReferencePose Empty() const;
  // An empty `end` means the joint's tail. Errors: kNotFound, kInvalidArgument.
  [[nodiscard]] Result<Limb> FindLimb(const std::string& parent, const std::string& joint,
                                      const std::string& end) const;
  // The lower bone bent fully from `straight` towards `side`, which lies across it.
  [[nodiscard]] ReferencePose Bent(const Limb& limb, const glm::vec3& straight,
                                   const glm::vec3& side, float beta_degrees) const;
  // The lower bone turned to `target` along the shortest way. If it points away from the target,
  // all ways are equally short, and it turns by way of `side`.
  [[nodiscard]] ReferencePose Turned(const Limb& limb, const glm::vec3& target,
                                     const glm::vec3& side) const;

  // Make errors that name the driver: kInvalidArgument with a reason, kNotFound for a joint, and
  // kUnsupported for kinds that no pose of joints raises.
  [[nodiscard]] Status CannotPose(const std::string& why) const;
  [[nodiscard]] Status MissingJoint(const std::string& joint) const;
  [[nodiscard]] Status Unsupported() const;

 private:
  std::string_view driver_;
  std::string_view value_;
  const Skeleton& skeleton_;
  std::span<const ReferencePose> reference_poses_;
  std::optional<float> degrees_;
};

// Two bones with a larger cosine between them are too close to parallel to define a way to bend.
inline constexpr float kAlmostStraight = 0.9998f;  // about 1 degree

// The unit part of `direction` across `bone`; zero if it lies within 6 degrees of the bone.
[[nodiscard]] glm::vec3 AcrossBone(const glm::vec3& direction, const glm::vec3& bone);

}  // namespace furrow::wrinkle
