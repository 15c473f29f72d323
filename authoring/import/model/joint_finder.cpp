// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/joint_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;
using wrinkle::kNoJoint;
using wrinkle::Skeleton;

// Determines roles from the shape of the hierarchy.
class HierarchyReader {
 public:
  explicit HierarchyReader(const Skeleton& skeleton)
      : skeleton_(skeleton),
        children_(static_cast<std::size_t>(skeleton.num_joints())),
        reach_(children_.size(), 0.0f),
        roles_(children_.size(), JointRole::kNone) {
    for (int j = skeleton.num_joints() - 1; j > 0; --j) {
      const int parent = skeleton.joint_parents()[j];
      if (parent < 0) continue;
      children_[parent].insert(children_[parent].begin(), j);
      reach_[parent] = std::max(reach_[parent], reach_[j] + glm::length(At(j) - At(parent)));
    }
  }

  // Returns no roles if the hierarchy is not that of a body.
  wrinkle::JointRoles Run() {
    const std::optional<Fork> hips = FindFork(0, 3);
    if (!hips) return {};
    int spine = kNoJoint;
    for (const int child : children_[hips->at]) {
      const bool is_leg = child == hips->pair.first || child == hips->pair.second;
      if (!is_leg && (spine < 0 || reach_[child] > reach_[spine])) spine = child;
    }
    const std::optional<Fork> chest = spine < 0 ? std::nullopt : FindFork(spine, 3);
    if (!chest) return {};
    roles_[hips->at] = JointRole::kHips;
    NameTrunk(hips->at, *chest);
    const bool first_is_left = FirstIsLeft(*hips, *chest);
    NameLeg(hips->pair.first, first_is_left);
    NameLeg(hips->pair.second, !first_is_left);
    // The arm nearer to a leg is on the same side.
    const glm::vec3 across = At(hips->pair.first) - At(hips->pair.second);
    const bool same = glm::dot(At(chest->pair.first) - At(chest->pair.second), across) > 0.0f;
    NameArm(chest->pair.first, first_is_left == same);
    NameArm(chest->pair.second, first_is_left != same);
    return std::move(roles_);
  }

 private:
  // A joint with two similar limbs below it.
  struct Fork {
    int at;
    std::pair<int, int> pair;
  };

  [[nodiscard]] glm::vec3 At(int joint) const {
    return glm::vec3(skeleton_.rest_model()[static_cast<std::size_t>(joint)][3]);
  }

  // The joints of the longest path down from `joint`, including it.
  [[nodiscard]] std::vector<int> LongestWay(int joint) const {
    std::vector<int> way = {joint};
    for (;;) {
      int best = kNoJoint;
      float longest = -1.0f;
      for (const int child : children_[way.back()]) {
        const float reach = reach_[child] + glm::length(At(child) - At(way.back()));
        if (reach > longest) best = child;
        longest = std::max(longest, reach);
      }
      if (best < 0) return way;
      way.push_back(best);
    }
  }

  // The topmost fork at or below `from` with limbs of at least `depth` joints.
  [[nodiscard]] std::optional<Fork> FindFork(int from, std::size_t depth) const {
    std::optional<Fork> best;
    float longest = 0.0f;
    for (int j = from; j < skeleton_.num_joints(); ++j) {
      if (!skeleton_.IsAncestor(from, j)) continue;
      const std::vector<int>& limbs = children_[j];
      for (std::size_t a = 0; a < limbs.size(); ++a) {
        for (std::size_t b = a + 1; b < limbs.size(); ++b) {
          if (!AreAlike(limbs[a], limbs[b], depth) || reach_[limbs[a]] <= longest) continue;
          best = Fork{j, {limbs[a], limbs[b]}};
          longest = reach_[limbs[a]];
        }
      }
      if (best) return best;
    }
    return best;
  }

  [[nodiscard]] bool AreAlike(int a, int b, std::size_t depth) const {
    const float longer = std::max(reach_[a], reach_[b]);
    return longer > 0.0f && std::abs(reach_[a] - reach_[b]) < 0.05f * longer &&
           LongestWay(a).size() >= depth && LongestWay(b).size() >= depth;
  }

  // Spine, chest and upper chest from the hips to the arms; neck and head above them.
  void NameTrunk(int hips, const Fork& chest) {
    std::vector<int> trunk;
    for (int j = chest.at; j != hips; j = skeleton_.joint_parents()[j]) trunk.push_back(j);
    std::reverse(trunk.begin(), trunk.end());
    constexpr std::array kTrunk = {JointRole::kSpine, JointRole::kChest, JointRole::kUpperChest};
    for (std::size_t i = 0; i < trunk.size(); ++i) {
      roles_[trunk[i]] = kTrunk[std::min<std::size_t>(i, 2)];
    }
    int neck = kNoJoint;
    for (const int child : children_[chest.at]) {
      const bool is_arm = child == chest.pair.first || child == chest.pair.second;
      if (!is_arm && (neck < 0 || reach_[child] > reach_[neck])) neck = child;
    }
    if (neck < 0) return;
    // A neck has a single joint below it. The first joint that branches or ends is the head.
    std::vector<int> way = {neck};
    while (children_[way.back()].size() == 1 && way.size() < 4) {
      way.push_back(children_[way.back()].front());
    }
    if (way.size() > 2 && children_[way.back()].empty()) way.pop_back();  // end of the crown
    roles_[way.back()] = JointRole::kHead;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) roles_[way[i]] = JointRole::kNeck;
  }

  // The feet point forward. Without feet, the limb on the side of +X is the left one.
  [[nodiscard]] bool FirstIsLeft(const Fork& hips, const Fork& chest) const {
    const glm::vec3 up = At(chest.at) - At(hips.at);
    const glm::vec3 across = At(hips.pair.first) - At(hips.pair.second);
    glm::vec3 forward(0.0f);
    for (const int leg : {hips.pair.first, hips.pair.second}) {
      const std::vector<int> way = LongestWay(leg);
      if (way.size() > 3) forward += At(way[3]) - At(way[2]);
    }
    forward -= up * (glm::dot(forward, up) / std::max(glm::dot(up, up), 1e-12f));
    if (glm::length(forward) < 0.05f * glm::length(up)) return across.x > 0.0f;
    return glm::dot(glm::cross(up, forward), across) > 0.0f;
  }

  void Name(int joint, JointRole left, bool is_left) {
    roles_[joint] = is_left ? left : wrinkle::MirrorOf(left);
  }

  void NameLeg(int leg, bool is_left) {
    const std::vector<int> way = LongestWay(leg);
    constexpr std::array kLeg = {JointRole::kLeftUpperLeg, JointRole::kLeftLowerLeg,
                                 JointRole::kLeftFoot, JointRole::kLeftToes};
    for (std::size_t i = 0; i < std::min(way.size(), kLeg.size()); ++i) {
      Name(way[i], kLeg[i], is_left);
    }
  }

  // The hand is where the fingers start. Without fingers it is the third or fourth joint.
  void NameArm(int arm, bool is_left) {
    const std::vector<int> way = LongestWay(arm);
    std::size_t hand = std::min<std::size_t>(way.size() - 1, 3);
    for (std::size_t i = 2; i < way.size(); ++i) {
      if (children_[way[i]].size() < 2) continue;
      hand = i;
      break;
    }
    Name(way[hand], JointRole::kLeftHand, is_left);
    Name(way[hand - 1], JointRole::kLeftLowerArm, is_left);
    Name(way[hand - 2], JointRole::kLeftUpperArm, is_left);
    if (hand > 2) Name(way[hand - 3], JointRole::kLeftShoulder, is_left);
  }

  const Skeleton& skeleton_;
  std::vector<std::vector<int>> children_;
  std::vector<float> reach_;  // distance from a joint down to its farthest leaf
  wrinkle::JointRoles roles_;
};

}  // namespace

int FoundJoints::First(JointRole role) const {
  const auto found = std::find(roles.begin(), roles.end(), role);
  return found == roles.end() ? kNoJoint : static_cast<int>(found - roles.begin());
}

int FoundJoints::Last(JointRole role) const {
  const auto found = std::find(roles.rbegin(), roles.rend(), role);
  return found == roles.rend() ? kNoJoint : static_cast<int>(roles.rend() - found) - 1;
}

FoundJoints FindJoints(const Skeleton& skeleton, const rig::SkeletonMaps& maps) {
  rig::SkeletonRoles known = maps.RolesOf(skeleton);
  FoundJoints found;
  found.map = std::move(known.map);
  found.roles = found.map.empty() ? HierarchyReader(skeleton).Run() : std::move(known.roles);
  found.roles.resize(static_cast<std::size_t>(skeleton.num_joints()), JointRole::kNone);
  std::vector<bool> seen(wrinkle::kNumJointRoles, false);
  for (const JointRole role : found.roles) {
    if (role == JointRole::kNone || seen[static_cast<std::size_t>(role)]) continue;
    seen[static_cast<std::size_t>(role)] = true;
    ++found.num_roles;
  }
  return found;
}

}  // namespace furrow::authoring
