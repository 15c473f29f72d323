// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/rest_pose.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "base/status.h"

namespace furrow::motion {

Status SetRestPose(std::span<const wrinkle::Transform> rest, Clip* clip) {
  if (rest.empty()) return {};
  const wrinkle::Skeleton& from = clip->skeleton;
  std::vector<wrinkle::JointDesc> joints;
  for (std::size_t j = 0; j < rest.size(); ++j) {
    joints.push_back({from.joint_names()[j], from.joint_parents()[j], rest[j], from.tails()[j]});
  }
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
  FURROW_RETURN_IF_ERROR(skeleton);
  clip->skeleton = std::move(*skeleton);  // parents come first, so the order stays
  return {};
}

}  // namespace furrow::motion
