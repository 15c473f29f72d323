// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/head_turn.h"

#include <algorithm>
#include <string_view>

#include "base/ascii.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {
namespace {

constexpr std::array<std::string_view, 3> kAngles = {"HeadYaw", "HeadPitch", "HeadRoll"};
constexpr float kNeckShare = 0.4f;
constexpr float kMaxAngle = 1.5f;  // radians

std::vector<int> JointsOf(const Skeleton& skeleton, const JointRoles& roles, JointRole role,
                          std::string_view name) {
  std::vector<int> joints;
  if (roles.empty()) {
    if (const int joint = skeleton.Find(name); joint != kNoJoint) joints.push_back(joint);
  }
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i] == role) joints.push_back(static_cast<int>(i));
  }
  return joints;
}

}  // namespace

bool IsTrackerAngle(std::string_view name) {
  for (const std::string_view of : {"Head", "LeftEye", "RightEye"}) {
    if (!EqualsIgnoreCase(name.substr(0, of.size()), of)) continue;
    const std::string_view angle = name.substr(of.size());
    for (const std::string_view head_angle : kAngles) {
      if (EqualsIgnoreCase(angle, head_angle.substr(std::string_view("Head").size()))) return true;
    }
  }
  return false;
}

HeadTurn HeadTurn::Create(const Skeleton& skeleton, const JointRoles& roles,
                          std::span<const std::string> blend_shapes) {
  HeadTurn turn;
  turn.num_joints_ = static_cast<std::size_t>(skeleton.num_joints());
  bool has_any = false;
  for (std::size_t angle = 0; angle < kAngles.size(); ++angle) {
    const auto found = std::ranges::find_if(blend_shapes, [&](const std::string& name) {
      return EqualsIgnoreCase(name, kAngles[angle]);
    });
    if (found == blend_shapes.end()) continue;
    turn.angles_[angle] = static_cast<int>(found - blend_shapes.begin());
    has_any = true;
  }
  const std::vector<int> head = JointsOf(skeleton, roles, JointRole::kHead, "head");
  if (!has_any || head.empty()) return turn;
  const std::vector<int> neck = JointsOf(skeleton, roles, JointRole::kNeck, "neck");
  const auto add = [&](int joint, float share) {
    const glm::quat parent = RestRotation(skeleton, skeleton.joint_parents()[joint]);
    turn.joints_.push_back({joint, share, glm::conjugate(parent)});
  };
  for (const int joint : neck) add(joint, kNeckShare / static_cast<float>(neck.size()));
  add(head.front(), neck.empty() ? 1.0f : 1.0f - kNeckShare);
  return turn;
}

JobStatus HeadTurn::Run(std::span<const float> coefficients, std::span<Transform> local) const {
  if (joints_.empty()) return JobStatus::kOk;
  if (local.size() < num_joints_) return JobStatus::kSizeMismatch;
  if (!AllFinite(coefficients)) return JobStatus::kNonFinite;
  const auto angle = [&](std::size_t which) {
    const auto shape = static_cast<std::size_t>(angles_[which]);
    const bool is_there = angles_[which] >= 0 && shape < coefficients.size();
    return is_there ? std::clamp(coefficients[shape], -kMaxAngle, kMaxAngle) : 0.0f;
  };
  // Model axes: X to the subject's left, Y up, Z to the front.
  const glm::quat whole = glm::angleAxis(angle(0), glm::vec3(0, 1, 0)) *
                          glm::angleAxis(-angle(1), glm::vec3(1, 0, 0)) *
                          glm::angleAxis(angle(2), glm::vec3(0, 0, 1));
  for (const Joint& joint : joints_) {
    const glm::quat part = glm::slerp(glm::quat(1.0f, 0.0f, 0.0f, 0.0f), whole, joint.share);
    const glm::quat turn = joint.to_parent * part * glm::conjugate(joint.to_parent);
    glm::quat& rotation = local[static_cast<std::size_t>(joint.joint)].rotation;
    rotation = glm::normalize(turn * rotation);
  }
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle
