// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::wrinkle {

// A measure of a skeleton's scale: the sum of the lengths of its rest bones, over the joints that
// it shares by name with `other`, or over all joints if `other` is null. Above 0 for a skeleton
// with extent.
[[nodiscard]] float SkeletonSize(const Skeleton& skeleton, const Skeleton* other = nullptr);

// How a skeleton stands at rest.
struct RestStance {
  // From the skeleton's model space to Furrow's (+Y up, facing +Z), in quarter turns.
  glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};
  // The toes point backwards, as seen from the sides that the roles state. Then left and right are
  // probably exchanged.
  bool toes_point_back = false;
  // The legs point the same way as the trunk, as in files that rest with all bones along one axis.
  // `turn` is then the identity.
  bool is_folded = false;
};

// Finds the stance from the rest places of joints with roles: up away from the limbs' ends
// (UpFromLimbs()), or else from the hips to the trunk or the head; left from the right leg, arm,
// shoulder or eye to the left one. A lean or a turn of less than 45 degrees counts as a stance and
// not as other axes. nullopt: the roles do not tell.
[[nodiscard]] std::optional<RestStance> FindRestStance(const Skeleton& skeleton,
                                                       const JointRoles& roles);

// The direction away from the ends of arms and legs, a unit vector in model space, if all of them
// point the same way at rest and the trunk does not. So a body on four legs is not stood upright.
// nullopt: they do not, or a limb is unknown.
[[nodiscard]] std::optional<glm::vec3> UpFromLimbs(const Skeleton& skeleton,
                                                   const JointRoles& roles);

class BodyRetarget;

// Carries poses from one skeleton to another. Created once per stream, then run once per pose.
//
// By name, a joint's departure from rest is carried in model axes (see JointDelta), so local frames
// may differ. Both rest poses should have the same stance. Translations are scaled by the ratio of
// sizes. Scales are carried as a ratio to rest. If local frames do not differ by a multiple of 90
// degrees, a non-uniform ratio is distributed over the target's axes; uniform ratios are always
// exact. Joints that the source lacks stay at rest. unmatched_source() lists joints that the target
// lacks.
//
// By role (joint_role.h, body_retarget.h), the two bodies may differ. The target's limbs, hands and
// fingers point in the source's directions, whatever the rest poses, local frames and proportions.
// Chains with different numbers of joints share the bend. The hips' motion is scaled by the length
// of the legs, so that feet that stand still stay still. Translations of other joints with roles
// are only carried if both bodies have the same shape; otherwise bones keep their length.
class Retarget {
 public:
  // `aliases`: (source name, target name), tried before equal names.
  [[nodiscard]] static Retarget Create(
      const Skeleton& source, const Skeleton& target,
      std::span<const std::pair<std::string, std::string>> aliases = {});

  // Carries by role the joints that have a role on both sides, and the others by equal names. Each
  // list has one role per joint. If either list is empty or has another length, all joints are
  // carried by name. `toes_height`: height of the source's toe joints above the floor when the feet
  // are flat, in leg lengths. It matters if the source's rest pose does not stand on the floor.
  // None: the target's height.
  [[nodiscard]] static Retarget Create(const Skeleton& source, const JointRoles& source_roles,
                                       const Skeleton& target, const JointRoles& target_roles,
                                       std::optional<float> toes_height = {});

  // True if joints are carried by role.
  [[nodiscard]] bool by_role() const { return body_ != nullptr; }
  // The source joints without any effect.
  [[nodiscard]] std::span<const std::string> unmatched_source() const { return unmatched_; }

  // Writes the target's local pose to `target`. `source`: the source's local pose. Each has at
  // least num_joints of its skeleton; kSizeMismatch otherwise. kNonFinite: `target` is unchanged.
  // Does not allocate.
  [[nodiscard]] JobStatus Run(std::span<const Transform> source, std::span<Transform> target) const;

 private:
  struct Joint {
    int source = kNoJoint;
    glm::quat source_rest_inverse;  // of the source's local rest rotation
    glm::quat to_target;            // inverse(G_target) * G_source
    glm::quat parent_to_target;     // inverse(G_target_parent) * G_source_parent
    glm::vec3 source_rest_translation{0.0f};
    glm::vec3 source_rest_scale{1.0f};
    Transform rest;  // target's
  };
  // `match`: the source joint of each target joint. `stance`: the target's model rotations in the
  // source's rest stance. `turn`: from the source's model space to the target's.
  void Plan(const Skeleton& source, const Skeleton& target, std::span<const int> match,
            std::span<const glm::quat> stance, const glm::quat& turn);
  [[nodiscard]] Transform Carry(const Joint& joint, const Transform& source) const;

  std::vector<Joint> joints_;
  std::vector<std::string> unmatched_;
  std::size_t num_source_ = 0;
  float scale_ = 1.0f;
  std::shared_ptr<const BodyRetarget> body_;  // null: all joints are carried by name
};

}  // namespace furrow::wrinkle
