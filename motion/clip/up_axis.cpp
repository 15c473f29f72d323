// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/up_axis.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/ascii.h"
#include "base/status.h"

namespace furrow::motion {
namespace {

// Nearly all skeletons name a head, and it is above the root in a rest pose.
bool NamesHead(std::string name) {
  name = AsciiLower(std::move(name));
  return name.find("head") != std::string::npos;
}

// -90 degrees about X: Z becomes Y, -Y becomes Z.
glm::vec3 Turn(const glm::vec3& v) { return {v.x, v.z, -v.y}; }

wrinkle::Transform Turn(const wrinkle::Transform& t) {
  wrinkle::Transform turned;
  turned.translation = Turn(t.translation);
  // Same angle about the turned axis: the vector part of a quaternion turns like a vector.
  turned.rotation =
      glm::quat(t.rotation.w, Turn(glm::vec3(t.rotation.x, t.rotation.y, t.rotation.z)));
  turned.scale = {t.scale.x, t.scale.z, t.scale.y};
  return turned;
}

}  // namespace

UpAxis FindUpAxis(const wrinkle::Skeleton& skeleton) {
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    if (!NamesHead(skeleton.joint_names()[index])) continue;
    int root = j;
    while (skeleton.joint_parents()[static_cast<std::size_t>(root)] != wrinkle::kNoJoint)
      root = skeleton.joint_parents()[static_cast<std::size_t>(root)];
    const glm::vec3 up(skeleton.rest_model()[index][3] -
                       skeleton.rest_model()[static_cast<std::size_t>(root)][3]);
    return up.z > std::abs(up.y) ? UpAxis::kZ : UpAxis::kY;
  }
  return UpAxis::kY;
}

Status TurnZUpToYUp(Clip* clip) {
  const wrinkle::Skeleton& skeleton = clip->skeleton;
  // Every local transform is turned by conjugation. The turns of parent and child cancel in
  // between, so all joints turn together.
  std::vector<wrinkle::JointDesc> joints;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    joints.push_back({skeleton.joint_names()[index], skeleton.joint_parents()[index],
                      Turn(skeleton.rest_pose()[index]), Turn(skeleton.tails()[index])});
  }
  Result<wrinkle::Skeleton> turned = wrinkle::Skeleton::Create(std::move(joints));
  FURROW_RETURN_IF_ERROR(turned);
  clip->skeleton = std::move(*turned);  // keeps the order, which had parents first
  for (wrinkle::Transform& local : clip->locals) local = Turn(local);
  return {};
}

}  // namespace furrow::motion
