// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/up_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

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

// The first joint that names a head, and its root; kNoJoint if there is none.
struct Trunk {
  int root = wrinkle::kNoJoint;
  int head = wrinkle::kNoJoint;
};

Trunk FindTrunk(const wrinkle::Skeleton& skeleton) {
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    if (!NamesHead(skeleton.joint_names()[static_cast<std::size_t>(j)])) continue;
    int root = j;
    while (skeleton.joint_parents()[static_cast<std::size_t>(root)] != wrinkle::kNoJoint)
      root = skeleton.joint_parents()[static_cast<std::size_t>(root)];
    return {root, j};
  }
  return {};
}

glm::vec3 Origin(std::span<const glm::mat4> model, int joint) {
  return glm::vec3(model[static_cast<std::size_t>(joint)][3]);
}

}  // namespace

UpAxis FindUpAxis(const wrinkle::Skeleton& skeleton) {
  const Trunk trunk = FindTrunk(skeleton);
  if (trunk.head == wrinkle::kNoJoint) return UpAxis::kY;
  const auto rest = skeleton.rest_model();
  const glm::vec3 up = Origin(rest, trunk.head) - Origin(rest, trunk.root);
  return up.z > std::abs(up.y) ? UpAxis::kZ : UpAxis::kY;
}

bool MovesAlongZ(const Clip& clip) {
  constexpr int kMaxSamples = 200;
  const Trunk trunk = FindTrunk(clip.skeleton);
  const int num_frames = clip.num_frames();
  if (trunk.head == wrinkle::kNoJoint || num_frames == 0) return false;
  float reach = 0.0f;
  const auto rest = clip.skeleton.rest_model();
  for (int j = 0; j < clip.skeleton.num_joints(); ++j) {
    reach = std::max(reach, Origin(rest, trunk.root).y - Origin(rest, j).y);
  }
  const int num_samples = std::min(num_frames, kMaxSamples);
  int num_upright = 0;
  wrinkle::LocalPose pose;
  std::vector<glm::mat4> model(rest.size());
  for (int i = 0; i < num_samples; ++i) {
    clip.GetPose(static_cast<int>(std::int64_t{i} * num_frames / num_samples), &pose);
    if ((wrinkle::LocalToModelJob{&clip.skeleton, pose.joints, model}).Run() !=
        wrinkle::JobStatus::kOk) {
      return false;
    }
    const glm::vec3 up = Origin(model, trunk.head) - Origin(model, trunk.root);
    float lowest = Origin(model, trunk.root).z;
    for (const glm::mat4& joint : model) lowest = std::min(lowest, joint[3].z);
    const bool stands = up.z > 0.7f * glm::length(up);
    if (stands && std::abs(lowest) < 0.25f * reach) ++num_upright;
  }
  return 10 * num_upright >= 9 * num_samples;
}

void TurnMotionUpright(Clip* clip) {
  const auto parents = clip->skeleton.joint_parents();
  const glm::quat turn = glm::angleAxis(glm::radians(-90.0f), glm::vec3(1.0f, 0.0f, 0.0f));
  for (std::size_t i = 0; i < clip->locals.size(); ++i) {
    if (parents[i % parents.size()] != wrinkle::kNoJoint) continue;
    wrinkle::Transform& local = clip->locals[i];
    local.translation = Turn(local.translation);
    local.rotation = glm::normalize(turn * local.rotation);
  }
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
