// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/floor.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "base/status.h"
#include "motion/clip/rest_pose.h"
#include "motion/clip/trunk.h"

namespace furrow::motion {
namespace {

constexpr float kStill = 1e-5f;  // of the reach: rounding of the file's text

// The height of the lowest joint in all frames.
float LowestJoint(const Clip& clip) {
  float lowest = std::numeric_limits<float>::max();
  const auto joints = static_cast<std::size_t>(clip.skeleton.num_joints());
  std::vector<glm::mat4> model(joints);
  for (std::size_t at = 0; at < clip.locals.size(); at += joints) {
    const auto local = std::span(clip.locals).subspan(at, joints);
    if ((wrinkle::LocalToModelJob{&clip.skeleton, local, model}).Run() != wrinkle::JobStatus::kOk) {
      continue;
    }
    for (const glm::mat4& joint : model) lowest = std::min(lowest, joint[3].y);
  }
  return lowest;
}

}  // namespace

Result<bool> RaiseToFloor(Clip* clip) {
  const Trunk trunk = FindTrunk(clip->skeleton);
  if (!trunk.has_head() || clip->locals.empty()) return false;
  const auto rest = clip->skeleton.rest_model();
  const float reach = Reach(clip->skeleton, trunk);
  const float height_of_head = OriginOf(rest, trunk.head).y - OriginOf(rest, trunk.root).y;
  const bool stands = trunk.up && trunk.up->y > 0.7f;
  const bool has_legs = stands || (height_of_head > 0.0f && reach > 0.5f * height_of_head);
  const float lowest = has_legs ? LowestJoint(*clip) : 0.0f;
  if (!has_legs || lowest > -0.25f * reach) return false;
  const auto parents = clip->skeleton.joint_parents();
  bool moves = false;
  for (std::size_t i = 0; i < clip->locals.size(); ++i) {
    if (parents[i % parents.size()] != wrinkle::kNoJoint) continue;
    glm::vec3& place = clip->locals[i].translation;
    const glm::vec3 from_rest = place - clip->skeleton.rest_pose()[i % parents.size()].translation;
    moves = moves || glm::length(from_rest) > kStill * reach;
    place.y -= lowest;
  }
  const float lowest_at_rest = OriginOf(rest, trunk.root).y - reach;
  const auto own = clip->skeleton.rest_pose();
  std::vector<wrinkle::Transform> raised(own.begin(), own.end());
  for (std::size_t j = 0; j < raised.size(); ++j) {
    if (parents[j] == wrinkle::kNoJoint) raised[j].translation.y -= lowest_at_rest;
  }
  FURROW_RETURN_IF_ERROR(SetRestPose(raised, clip));
  return moves;
}

}  // namespace furrow::motion
