// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "wrinkle/skeleton/body_stance.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::wrinkle {

// The part of Retarget that knows bodies: carries the rotations of joints with roles and the place
// of the hips. Private to wrinkle/; docs/SKELETONS.md says what it does for users.
//
// A joint's turn away from rest is measured in model space, so that local frames, what stands
// between two joints and how many of them there are do not matter. Put onto a target that stands as
// the source rests (AlignedStance()), it gives the source's directions.
class BodyRetarget {
 public:
  struct Fit {
    glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};  // QuarterTurn(source, target)
    std::vector<glm::quat> stance;           // AlignedStance(source, target, turn)
    float scale = 1.0f;                      // of the hips' motion
    bool same_shape = false;                 // joint goes to joint: nothing is shared out or swung
    std::optional<float> toes_height;        // see Retarget::Create()
  };
  BodyRetarget(const Body& source, const Body& target, const Fit& fit);

  // True where the target's joint takes its rotation from here.
  [[nodiscard]] bool Carries(int target_joint) const {
    return joints_[static_cast<std::size_t>(target_joint)].to != kNoJoint;
  }

  // One a joint of the source: whether a rotation is made from its turn, or from that of a joint
  // below it (turns are measured in model space: whatever stands above has its say).
  [[nodiscard]] std::vector<bool> ReadJoints() const;

  // `target` holds a local pose; the rotations of what is carried and the hips' translation are
  // replaced. Sizes as Retarget::Run() has checked them. Does not allocate.
  void Run(std::span<const Transform> source, std::span<Transform> target) const;

 private:
  // Where a joint's turn comes from: between those of two joints of the source, and for a limb
  // swung so that the whole bone points as the source's does.
  struct Joint {
    int from = kNoJoint;        // source joints; `from` kNoJoint: no turn
    int to = kNoJoint;          // kNoJoint: not carried
    float between = 1.0f;       // 0: as `from`, 1: as `to`
    float twist = 1.0f;         // a limb's joint: share of the bone's twist against `from`
    int first = kNoJoint;       // the source's bone where other joints lie along it: from here
    int end = kNoJoint;         // to there
    glm::vec3 direction{0.0f};  // of the source's bone at rest: unit, model space, turned
    glm::quat stance{1.0f, 0.0f, 0.0f, 0.0f};
  };
  using Rotations = std::array<glm::quat, kMaxJoints>;

  void PlanChain(const Body& source, const Body& target, std::span<const JointRole> roles);
  void PlanBone(const Body& source, const Body& target, JointRole role);
  void PlanTree(const Body& source, const Body& target);
  void PlanPairs(const Body& source, const Body& target);
  void PlanHips(const Body& source, const Body& target, std::optional<float> toes_height);

  [[nodiscard]] glm::quat Turn(int source_joint, const Rotations& rotations) const;
  [[nodiscard]] glm::quat TurnOf(const Joint& joint, const Rotations& rotations) const;
  [[nodiscard]] glm::vec3 BoneVector(const Joint& joint, const Rotations& rotations) const;
  [[nodiscard]] glm::vec3 HipsPlace(std::span<const Transform> pose) const;
  void PlaceHips(std::span<const Transform> source, std::span<Transform> target) const;

  std::vector<Joint> joints_;  // the target's
  std::vector<std::int16_t> source_parents_;
  std::vector<std::int16_t> target_parents_;
  std::vector<glm::quat> source_rest_;   // model-space rotations
  std::vector<Transform> source_local_;  // rest pose
  glm::quat turn_;
  int source_hips_ = kNoJoint;
  int target_hips_ = kNoJoint;
  float scale_ = 1.0f;
  glm::vec3 source_origin_{0.0f};      // the source's place that is ...
  glm::vec3 target_origin_{0.0f};      // ... this place of the target, model space
  glm::vec3 target_rest_place_{0.0f};  // of the hips
  glm::vec3 source_rest_place_{0.0f};
  bool rests_off_floor_ = false;
  float still_ = 0.0f;  // hips no further from rest than this have not moved
};

}  // namespace furrow::wrinkle
