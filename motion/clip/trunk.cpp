// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/trunk.h"

#include <algorithm>

#include "base/ascii.h"
#include "wrinkle/hierarchy/hierarchy_roles.h"

namespace furrow::motion {

Trunk FindTrunk(const wrinkle::Skeleton& skeleton) {
  Trunk trunk;
  if (const auto shape = wrinkle::FindBodyShape(skeleton)) {
    trunk = {shape->root, shape->head, shape->up, !shape->is_upright};
  }
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const std::string name = AsciiLower(skeleton.joint_names()[static_cast<std::size_t>(j)]);
    if (name.find("head") == std::string::npos) continue;
    trunk.root = trunk.head = j;
    while (skeleton.joint_parents()[static_cast<std::size_t>(trunk.root)] != wrinkle::kNoJoint)
      trunk.root = skeleton.joint_parents()[static_cast<std::size_t>(trunk.root)];
    break;
  }
  return trunk;
}

float Reach(const wrinkle::Skeleton& skeleton, const Trunk& trunk) {
  const auto rest = skeleton.rest_model();
  const float root = OriginOf(rest, trunk.root).y;
  float reach = 0.0f;
  for (const glm::mat4& joint : rest) reach = std::max(reach, root - joint[3].y);
  return reach;
}

}  // namespace furrow::motion
