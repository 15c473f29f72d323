// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/up_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/status.h"
#include "motion/clip/trunk.h"

namespace furrow::motion {
namespace {

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
  const Trunk trunk = FindTrunk(skeleton);
  const auto axis = [](const glm::vec3& up) {
    return up.z > std::abs(up.y) ? UpAxis::kZ : UpAxis::kY;
  };
  // Legs along X point neither way, as in LaFAN1, whose bones all rest along X.
  if (trunk.up && std::abs(trunk.up->x) < 0.7f) return axis(*trunk.up);
  if (!trunk.has_head()) return UpAxis::kAuto;
  const auto rest = skeleton.rest_model();
  return axis(OriginOf(rest, trunk.head) - OriginOf(rest, trunk.root));
}

bool IsLongestAlongZ(const wrinkle::Skeleton& skeleton) {
  if (skeleton.num_joints() == 0) return false;
  const auto rest = skeleton.rest_model();
  glm::vec3 low = OriginOf(rest, 0);
  glm::vec3 high = low;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    const glm::vec3 tail(rest[at] * glm::vec4(skeleton.tails()[at], 1.0f));
    for (const glm::vec3& point : {OriginOf(rest, j), tail}) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
  }
  return high.z - low.z > high.y - low.y;
}

bool MovesAlongZ(const Clip& clip) {
  constexpr int kMaxSamples = 200;
  const Trunk trunk = FindTrunk(clip.skeleton);
  const int num_frames = clip.num_frames();
  if (!trunk.has_head() || trunk.on_four_legs || num_frames == 0) return false;
  const float reach = Reach(clip.skeleton, trunk);
  const int num_samples = std::min(num_frames, kMaxSamples);
  int num_upright = 0;
  wrinkle::LocalPose pose;
  std::vector<glm::mat4> model(static_cast<std::size_t>(clip.skeleton.num_joints()));
  for (int i = 0; i < num_samples; ++i) {
    clip.GetPose(static_cast<int>(std::int64_t{i} * num_frames / num_samples), &pose);
    if ((wrinkle::LocalToModelJob{&clip.skeleton, pose.joints, model}).Run() !=
        wrinkle::JobStatus::kOk) {
      return false;
    }
    const glm::vec3 up = OriginOf(model, trunk.head) - OriginOf(model, trunk.root);
    float lowest = OriginOf(model, trunk.root).z;
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
