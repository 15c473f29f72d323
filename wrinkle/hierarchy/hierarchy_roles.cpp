// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/hierarchy/hierarchy_roles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "wrinkle/skeleton/direction.h"

namespace furrow::wrinkle {
namespace {

// The least cosine between the legs and the way down the trunk if the arms point down like the
// legs, so that they may be front legs: 37 degrees. A person with hanging arms is straighter. Of
// other bodies, kLeastAlike is enough.
constexpr float kLeastUpright = 0.8f;

// The first bone of a leg lies above the thigh if it is shorter than this share of the next two.
constexpr float kShortBone = 0.6f;

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
  JointRoles Run() {
    const std::optional<Forks> forks = FindForks();
    if (!forks || !StandsUpright(forks->hips, forks->chest)) return {};
    const Fork& hips = forks->hips;
    const Fork& chest = forks->chest;
    roles_[hips.at] = JointRole::kHips;
    NameTrunk(hips.at, chest);
    const bool first_is_left = FirstIsLeft(hips, chest);
    NameLeg(hips.pair.first, first_is_left);
    NameLeg(hips.pair.second, !first_is_left);
    // The arm nearer to a leg is on the same side.
    const glm::vec3 across = At(hips.pair.first) - At(hips.pair.second);
    const bool same = glm::dot(At(chest.pair.first) - At(chest.pair.second), across) > 0.0f;
    NameArm(chest.pair.first, first_is_left == same);
    NameArm(chest.pair.second, first_is_left != same);
    return std::move(roles_);
  }

  [[nodiscard]] std::optional<BodyShape> Shape() const {
    const std::optional<Forks> forks = FindForks();
    if (!forks) return std::nullopt;
    const auto [first, second] = forks->hips.pair;
    const glm::vec3 legs = Reached(first) + Reached(second);
    if (!PointAlike(Reached(first), Reached(second))) return std::nullopt;
    BodyShape shape;
    shape.is_upright = StandsUpright(forks->hips, forks->chest);
    if (!shape.is_upright) {
      // Both pairs of legs point down, across the trunk.
      const auto [left, right] = forks->chest.pair;
      if (!PointAlike(Reached(left) + Reached(right), legs)) return std::nullopt;
      const glm::vec3 trunk = At(forks->chest.at) - At(forks->hips.at);
      if (PointAlike(trunk, legs)) return std::nullopt;  // folded: all bones on one line
    }
    shape.up = -glm::normalize(legs);
    shape.root = forks->hips.at;
    while (skeleton_.joint_parents()[shape.root] >= 0) {
      shape.root = skeleton_.joint_parents()[shape.root];
    }
    const std::vector<int> neck = Neck(forks->chest);
    shape.head = neck.empty() ? forks->chest.at : neck.back();
    return shape;
  }

 private:
  // A joint with two similar limbs below it.
  struct Fork {
    int at;
    std::pair<int, int> pair;
  };
  struct Forks {
    Fork hips;
    Fork chest;
  };

  [[nodiscard]] std::optional<Forks> FindForks() const {
    std::optional<Fork> hips = FindFork(0, 3);
    if (!hips) return std::nullopt;
    SkipShortBones(&*hips);
    int spine = kNoJoint;
    for (const int child : children_[hips->at]) {
      const bool is_leg = IsLimb(child, *hips);
      if (!is_leg && (spine < 0 || reach_[child] > reach_[spine])) spine = child;
    }
    const std::optional<Fork> chest = spine < 0 ? std::nullopt : FindFork(spine, 3);
    if (!chest) return std::nullopt;
    return Forks{*hips, *chest};
  }

  // Starts both legs at the thigh, the first of two long bones: some rigs have a bone of the
  // buttock or of the hip above it.
  void SkipShortBones(Fork* hips) const {
    std::vector<int> first = LongestWay(hips->pair.first);
    std::vector<int> second = LongestWay(hips->pair.second);
    while (StartsShort(first) && StartsShort(second)) {
      first.erase(first.begin());
      second.erase(second.begin());
    }
    hips->pair = {first.front(), second.front()};
  }

  // True if a way down a leg has two bones below its first that are both longer.
  [[nodiscard]] bool StartsShort(const std::vector<int>& way) const {
    if (way.size() < 4) return false;
    const auto length = [&](std::size_t i) { return glm::length(At(way[i + 1]) - At(way[i])); };
    return length(0) < kShortBone * std::min(length(1), length(2));
  }

  // From the start of a limb to its end.
  [[nodiscard]] glm::vec3 Reached(int limb) const { return At(LongestWay(limb).back()) - At(limb); }

  // True if a child of the fork leads to one of its limbs.
  [[nodiscard]] bool IsLimb(int child, const Fork& fork) const {
    return skeleton_.IsAncestor(child, fork.pair.first) ||
           skeleton_.IsAncestor(child, fork.pair.second);
  }

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
          // Long and equal: a spine may be almost as long as a leg.
          const float score = reach_[limbs[a]] * (1.0f - 20.0f * Difference(limbs[a], limbs[b]));
          if (!AreAlike(limbs[a], limbs[b], depth) || score <= longest) continue;
          best = Fork{j, {Start(j, limbs[a]), Start(j, limbs[b])}};
          longest = score;
        }
      }
      if (best) return best;
    }
    return best;
  }

  // Of the lengths of two limbs, as a share of the longer one.
  [[nodiscard]] float Difference(int a, int b) const {
    const float longer = std::max(reach_[a], reach_[b]);
    return longer > 0.0f ? std::abs(reach_[a] - reach_[b]) / longer : 1.0f;
  }

  [[nodiscard]] bool AreAlike(int a, int b, std::size_t depth) const {
    return Difference(a, b) < 0.05f && LongestWay(a).size() >= depth &&
           LongestWay(b).size() >= depth;
  }

  // The first joint of a limb that is away from the fork: CMU's files have "LHipJoint" in the hips.
  [[nodiscard]] int Start(int fork, int limb) const {
    const std::vector<int> way = LongestWay(limb);
    for (std::size_t i = 0; i + 3 <= way.size(); ++i) {
      if (glm::length(At(way[i]) - At(fork)) > 0.01f * reach_[limb]) return way[i];
    }
    return limb;
  }

  // The legs of a person point away from the trunk. Those of a fox are across it, and a fox must
  // not be stood upright. Legs count down to their ends, because hind legs are bent at rest.
  [[nodiscard]] bool StandsUpright(const Fork& hips, const Fork& chest) const {
    const glm::vec3 trunk = At(chest.at) - At(hips.at);
    const glm::vec3 legs = Reached(hips.pair.first) + Reached(hips.pair.second);
    const bool like_legs =
        PointAlike(Reached(chest.pair.first), legs) && PointAlike(Reached(chest.pair.second), legs);
    return PointAlike(trunk, -legs, like_legs ? kLeastUpright : kLeastAlike);
  }

  // The joints of the neck from the fork of the arms up to the head. Empty if there are none.
  [[nodiscard]] std::vector<int> Neck(const Fork& chest) const {
    int neck = kNoJoint;
    for (const int child : children_[chest.at]) {
      const bool is_arm = IsLimb(child, chest);
      if (!is_arm && (neck < 0 || reach_[child] > reach_[neck])) neck = child;
    }
    if (neck < 0) return {};
    // A neck has a single joint below it. The first joint that branches or ends is the head.
    std::vector<int> way = {neck};
    while (children_[way.back()].size() == 1 && way.size() < 4) {
      way.push_back(children_[way.back()].front());
    }
    if (way.size() > 2 && children_[way.back()].empty()) way.pop_back();  // end of the crown
    return way;
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
    const std::vector<int> way = Neck(chest);
    if (way.empty()) return;
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
    roles_[joint] = is_left ? left : MirrorOf(left);
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
  JointRoles roles_;
};

}  // namespace

JointRoles RolesFromHierarchy(const Skeleton& skeleton) {
  if (skeleton.num_joints() == 0) return {};
  return HierarchyReader(skeleton).Run();
}

std::optional<BodyShape> FindBodyShape(const Skeleton& skeleton) {
  if (skeleton.num_joints() == 0) return std::nullopt;
  return HierarchyReader(skeleton).Shape();
}

}  // namespace furrow::wrinkle
