// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wrinkle/pose.h"

namespace furrow::wrinkle {

// A length that tells a skeleton's scale: the sum of its rest bones'
// lengths over the joints it shares by name with `other` (over all
// joints when `other` is null). Never 0 for a skeleton with extent.
[[nodiscard]] float SkeletonSize(const Skeleton& skeleton, const Skeleton* other = nullptr);

// Carries poses of one skeleton to another by joint name: made once a stream, then one pass a pose.
//
// A joint's departure from rest travels in model axes (see JointDelta), so local frames may differ;
// both rest poses should show the same stance. Translations are scaled by the ratio of sizes.
// Scales are carried as a ratio to rest; where local frames differ by no multiple of 90 degrees, a
// non-uniform ratio is spread over the target's axes (uniform ones are always exact).
// Joints that the source lacks rest; source joints that the target lacks are listed once.
class Retarget {
 public:
  // `aliases`: (source name, target name), tried before equal names.
  [[nodiscard]] static Retarget Create(
      const Skeleton& source, const Skeleton& target,
      std::span<const std::pair<std::string, std::string>> aliases = {});

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
  [[nodiscard]] Transform Carry(const Joint& joint, const Transform& source) const;

  std::vector<Joint> joints_;
  std::vector<std::string> unmatched_;
  std::size_t num_source_ = 0;
  float scale_ = 1.0f;
};

}  // namespace furrow::wrinkle
