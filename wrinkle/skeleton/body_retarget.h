// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "wrinkle/skeleton/body_stance.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::wrinkle {

// The part of Retarget for bodies: carries the rotations of joints with roles and the position of
// the hips. Private to wrinkle/. docs/SKELETONS.md explains it to users.
//
// A joint's turn away from rest is measured in model space, so local frames and the number of
// joints in between do not matter. Applied to a target in the source's rest stance
// (AlignedStance()), the turns give the source's directions.
class BodyRetarget {
 public:
  struct Fit {
    glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};  // QuarterTurn(source, target)
    std::vector<glm::quat> stance;           // AlignedStance(source, target, turn)
    float scale = 1.0f;                      // of the hips' motion
    bool same_shape = false;           // joints correspond one to one: no turn is divided or swung
    std::optional<float> toes_height;  // see Retarget::Create()
  };
  BodyRetarget(const Body& source, const Body& target, const Fit& fit);

  // True if this object sets the rotation of the target's joint.
  [[nodiscard]] bool Carries(int target_joint) const {
    return joints_[static_cast<std::size_t>(target_joint)].to != kNoJoint;
  }

  // One entry per source joint: true if some rotation depends on the joint. Turns are measured in
  // model space, so a turn also depends on all joints above its own.
  [[nodiscard]] std::vector<bool> ReadJoints() const;

  // Replaces the rotations of carried joints and the hips' translation in `target`, a local pose.
  // Precondition: the sizes that Retarget::Run() checks. Does not allocate.
  void Run(std::span<const Transform> source, std::span<Transform> target) const;

 private:
  // The source of a joint's turn: interpolated between the turns of two source joints. A limb's
  // turn is also swung, so that the whole bone points in the direction of the source's bone.
  struct Joint {
    int from = kNoJoint;        // source joints; `from` kNoJoint: no turn
    int to = kNoJoint;          // kNoJoint: not carried
    float between = 1.0f;       // 0: as `from`, 1: as `to`
    float twist = 1.0f;         // for limbs: share of the bone's twist relative to `from`
    int first = kNoJoint;       // the source's bone, if joints lie along it: its first joint
    int end = kNoJoint;         // and its end
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
  glm::vec3 source_origin_{0.0f};      // this position of the source corresponds
  glm::vec3 target_origin_{0.0f};      // to this position of the target, model space
  glm::vec3 target_rest_place_{0.0f};  // of the hips
  glm::vec3 source_rest_place_{0.0f};
  bool rests_off_floor_ = false;
  float still_ = 0.0f;  // smaller distances of the hips from rest count as no motion
};

}  // namespace furrow::wrinkle
