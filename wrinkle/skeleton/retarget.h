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

// A length that tells a skeleton's scale: the sum of its rest bones'
// lengths over the joints it shares by name with `other` (over all
// joints when `other` is null). Never 0 for a skeleton with extent.
[[nodiscard]] float SkeletonSize(const Skeleton& skeleton, const Skeleton* other = nullptr);

class BodyRetarget;

// Carries poses of one skeleton to another: made once a stream, then one pass a pose.
//
// By name, a joint's departure from rest travels in model axes (see JointDelta), so local frames
// may differ; both rest poses should show the same stance. Translations are scaled by the ratio of
// sizes. Scales are carried as a ratio to rest; where local frames differ by no multiple of 90
// degrees, a non-uniform ratio is spread over the target's axes (uniform ones are always exact).
// Joints that the source lacks rest; source joints that the target lacks are listed once.
//
// By role (see joint_role.h; body_retarget.h says how), two bodies need not be alike: the target's
// limbs, hands and fingers point where the source's do, whatever the two rest poses, local frames
// and proportions; chains of unlike counts share the bend; hips travel as far as the legs are long,
// so that feet which stand still do. Translations of other joints with roles are carried where both
// bodies have the same shape, and no others: bones keep their length.
class Retarget {
 public:
  // `aliases`: (source name, target name), tried before equal names.
  [[nodiscard]] static Retarget Create(
      const Skeleton& source, const Skeleton& target,
      std::span<const std::pair<std::string, std::string>> aliases = {});

  // By role where a joint has one on both sides, the rest by equal names. Roles one a joint each;
  // where either list is empty or of another length, all goes by name.
  // `toes_height`: of the source's toes' joints above the floor where feet stand flat, in leg
  // lengths; matters where its rest pose does not stand on the floor. Unknown: as the target's.
  [[nodiscard]] static Retarget Create(const Skeleton& source, const JointRoles& source_roles,
                                       const Skeleton& target, const JointRoles& target_roles,
                                       std::optional<float> toes_height = {});

  // True where joints are carried by role.
  [[nodiscard]] bool by_role() const { return body_ != nullptr; }
  // Joints of the source that change nothing.
  [[nodiscard]] std::span<const std::string> unmatched_source() const { return unmatched_; }

  // `source` num_joints of the source, `target` of the target. Does not allocate.
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
  // `match`: the source's joint of each of the target's. `stance`: the target's model rotations
  // where it stands as the source does at rest. `turn`: source's model space to the target's.
  void Plan(const Skeleton& source, const Skeleton& target, std::span<const int> match,
            std::span<const glm::quat> stance, const glm::quat& turn);
  [[nodiscard]] Transform Carry(const Joint& joint, const Transform& source) const;

  std::vector<Joint> joints_;
  std::vector<std::string> unmatched_;
  std::size_t num_source_ = 0;
  float scale_ = 1.0f;
  std::shared_ptr<const BodyRetarget> body_;  // null: all goes by name
};

}  // namespace furrow::wrinkle
