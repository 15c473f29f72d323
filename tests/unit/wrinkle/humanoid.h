// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/unit/wrinkle/test_characters.h"
#include "wrinkle/skeleton/joint_role.h"

namespace furrow::wrinkle {

// A body with joint roles that tests can change: remove and split joints, bend the rest pose.
struct Humanoid {
  struct Joint {
    JointRole role;
    ModelJoint place;
  };
  std::vector<Joint> joints;

  // Turns `joint` and all below it about its origin, by degrees about `axis`.
  void Turn(const std::string& joint, float degrees, const glm::vec3& axis);
  // Removes a joint; its parent becomes the parent of its children.
  void Remove(const std::string& joint);
  // A new joint of the same role right below `joint`, `share` of the way to `end`.
  void Split(const std::string& joint, const std::string& end, float share);
  void Transform(const glm::quat& rotation, float scale, const glm::vec3& shift);
  void Prefix(const std::string& prefix);

  [[nodiscard]] Skeleton Build(unsigned frame_seed = 0) const {
    return MakeSkeleton(Places(), frame_seed);
  }
  [[nodiscard]] JointRoles Roles() const;

 private:
  [[nodiscard]] std::vector<ModelJoint> Places() const;
  [[nodiscard]] bool IsBelow(const ModelJoint& joint, const std::string& above) const;
};

// 1.7 m tall, in a T-pose, facing +Z; joints are named by their role. With thumb, index, middle and
// little finger on both hands.
Humanoid MakeHumanoid();

}  // namespace furrow::wrinkle
