// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/body_retarget.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "wrinkle/skeleton/twist.h"

namespace furrow::wrinkle {
namespace {

using enum JointRole;

const glm::quat kNoTurn(1.0f, 0.0f, 0.0f, 0.0f);
// Hips closer to their rest than this distance, in leg lengths, have not moved. The distance covers
// the rounding of a file's text and of the joints above.
constexpr float kStill = 1e-5f;

std::size_t At(int index) { return static_cast<std::size_t>(index); }

// The last joint of the nearest role above `role` that exists in the body.
int JointAbove(const Body& body, JointRole role) {
  for (JointRole above = ParentOf(role); above != kNone; above = ParentOf(above)) {
    if (body.Last(above) != kNoJoint) return body.Last(above);
  }
  return kNoJoint;
}

// The joints of several roles as one chain, parents first.
std::vector<int> JointsOf(const Body& body, std::span<const JointRole> roles) {
  std::vector<int> joints;
  for (const JointRole role : roles) {
    const auto chain = body.Chain(role);
    joints.insert(joints.end(), chain.begin(), chain.end());
  }
  return joints;
}

// Limbs are long bones: their direction must match, and their twist is spread over twist joints.
bool IsLimb(JointRole role) {
  switch (role) {
    case kLeftUpperArm:
    case kLeftLowerArm:
    case kLeftUpperLeg:
    case kLeftLowerLeg:
    case kRightUpperArm:
    case kRightLowerArm:
    case kRightUpperLeg:
    case kRightLowerLeg: return true;
    default: return false;
  }
}

// Model space of one joint, without the cost of the whole skeleton.
glm::mat4 ModelOf(int joint, std::span<const std::int16_t> parents,
                  std::span<const Transform> pose) {
  glm::mat4 model(1.0f);
  for (; joint != kNoJoint; joint = parents[At(joint)]) model = ToMatrix(pose[At(joint)]) * model;
  return model;
}

// True if the rest pose stands on a floor at height 0. That of a BVH file often does not: its root
// rests at the origin, and only its motion states the position.
bool StandsOnFloor(const Body& body, float leg) {
  const float height = glm::dot(body.RestOrigin(body.First(kHips)), UpAxis(body));
  return std::abs(height - leg) < 0.3f * leg;
}

}  // namespace

BodyRetarget::BodyRetarget(const Body& source, const Body& target, const Fit& fit)
    : joints_(fit.stance.size()),
      source_parents_(source.skeleton().joint_parents().begin(),
                      source.skeleton().joint_parents().end()),
      target_parents_(target.skeleton().joint_parents().begin(),
                      target.skeleton().joint_parents().end()),
      source_rest_(source.skeleton().rest_model_rotations().begin(),
                   source.skeleton().rest_model_rotations().end()),
      source_local_(source.skeleton().rest_pose().begin(), source.skeleton().rest_pose().end()),
      turn_(fit.turn),
      scale_(fit.scale) {
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].stance = fit.stance[i];
  if (fit.same_shape) {
    PlanPairs(source, target);
  } else {
    PlanTree(source, target);
  }
  PlanHips(source, target, fit.toes_height);
}

std::vector<bool> BodyRetarget::ReadJoints() const {
  std::vector<bool> read(source_parents_.size(), false);
  for (const Joint& joint : joints_) {
    if (joint.to == kNoJoint) continue;
    read[At(joint.to)] = true;
    if (joint.from != kNoJoint) read[At(joint.from)] = true;
  }
  // Parents precede children, so one pass from the end reaches all ancestors.
  for (std::size_t i = read.size(); i-- > 0;) {
    if (read[i] && source_parents_[i] != kNoJoint) read[At(source_parents_[i])] = true;
  }
  return read;
}

// Joints with equal places in the chains of a role correspond.
void BodyRetarget::PlanPairs(const Body& source, const Body& target) {
  for (int i = 1; i < kNumJointRoles; ++i) {
    const auto from = source.Chain(static_cast<JointRole>(i));
    const auto to = target.Chain(static_cast<JointRole>(i));
    for (std::size_t j = 0; j < std::min(from.size(), to.size()); ++j) {
      joints_[At(to[j])].to = from[j];
    }
  }
}

void BodyRetarget::PlanTree(const Body& source, const Body& target) {
  // Rigs divide the spine and the neck differently, so their roles form one chain each.
  constexpr JointRole kTorso[] = {kSpine, kChest, kUpperChest};
  constexpr JointRole kTop[] = {kNeck, kHead};
  PlanChain(source, target, kTorso);
  PlanChain(source, target, kTop);
  for (int i = 1; i < kNumJointRoles; ++i) {
    const auto role = static_cast<JointRole>(i);
    if (IsLimb(role)) {
      PlanBone(source, target, role);
    } else if (role == kHips || role > kHead) {
      PlanChain(source, target, {&role, 1});
    }
  }
}

// Distributes the turns of the source's chain evenly over the target's chain. The last joint always
// receives the last turn. If the target has more joints, its first joint receives part of the first
// turn.
void BodyRetarget::PlanChain(const Body& source, const Body& target,
                             std::span<const JointRole> roles) {
  const std::vector<int> from = JointsOf(source, roles);
  const std::vector<int> to = JointsOf(target, roles);
  if (from.empty()) return;
  const int above = JointAbove(source, roles.front());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const std::size_t place = (i + 1) * from.size();  // in steps of 1 / to.size()
    const std::size_t lower = place / to.size();      // source joints passed completely
    const std::size_t part = place % to.size();
    Joint& joint = joints_[At(to[i])];
    joint.from = lower == 0 ? above : from[lower - 1];
    joint.to = part == 0 ? from[lower - 1] : from[lower];
    joint.between = part == 0 ? 1.0f : static_cast<float>(part) / static_cast<float>(to.size());
  }
}

// One bone of a limb: every target joint receives the whole swing; the twist grows along the bone.
void BodyRetarget::PlanBone(const Body& source, const Body& target, JointRole role) {
  const std::span<const int> from = source.Chain(role);
  const std::span<const int> to = target.Chain(role);
  if (from.empty()) return;
  const auto bone = source.RestSpan(role, BoneEnd(role));
  const int end = source.First(BoneEnd(role));
  for (std::size_t i = 0; i < to.size(); ++i) {
    Joint& joint = joints_[At(to[i])];
    joint.from = JointAbove(source, role);
    joint.to = from.back();
    if (!bone) continue;
    joint.direction = turn_ * glm::normalize(*bone);
    joint.twist = static_cast<float>(i + 1) / static_cast<float>(to.size());
    // Joints between the ends of the source's bone (twist joints, for example) may bend it. Then
    // the direction is measured from end to end.
    const bool direct = source_parents_[At(end)] == from.front();
    if (!direct && source.skeleton().IsAncestor(from.front(), end)) {
      joint.first = from.front();
      joint.end = end;
    }
  }
}

void BodyRetarget::PlanHips(const Body& source, const Body& target,
                            std::optional<float> toes_height) {
  source_hips_ = source.First(kHips);
  target_hips_ = target.First(kHips);
  if (source_hips_ == kNoJoint || target_hips_ == kNoJoint) return;
  // By default, rest corresponds to rest.
  source_rest_place_ = source.RestOrigin(source_hips_);
  target_rest_place_ = target.RestOrigin(target_hips_);
  source_origin_ = source_rest_place_;
  target_origin_ = target_rest_place_;
  const float source_leg = LegLength(source, target);
  const float target_leg = LegLength(target, source);
  if (source_leg <= 0.0f || target_leg <= 0.0f) return;
  rests_off_floor_ = !StandsOnFloor(source, source_leg) && StandsOnFloor(target, target_leg);
  if (!rests_off_floor_) return;
  still_ = kStill * source_leg;
  // Both bodies share the floor: the source's standing hips correspond to the target's resting
  // hips.
  // The leg's length ends at the toes. `toes_height`, in leg lengths, adds their height above the
  // floor.
  const glm::vec3 up = UpAxis(target);
  const float target_height = glm::dot(target_rest_place_, up);
  const float source_height =
      toes_height ? source_leg * (1.0f + *toes_height) : target_height / scale_;
  source_origin_ = glm::conjugate(turn_) * (source_height * up);
  target_origin_ = target_height * up;
}

glm::quat BodyRetarget::Turn(int source_joint, const Rotations& rotations) const {
  if (source_joint == kNoJoint) return kNoTurn;
  const glm::quat turn =
      rotations[At(source_joint)] * glm::conjugate(source_rest_[At(source_joint)]);
  // The same turn, expressed in the target's model space.
  return turn_ * turn * glm::conjugate(turn_);
}

// Uses the lengths of the rest pose, because many senders omit translations.
glm::vec3 BodyRetarget::BoneVector(const Joint& joint, const Rotations& rotations) const {
  glm::vec3 bone(0.0f);
  for (int i = joint.end; i != joint.first; i = source_parents_[At(i)]) {
    bone += rotations[At(source_parents_[At(i)])] * source_local_[At(i)].translation;
  }
  return turn_ * bone;
}

glm::quat BodyRetarget::TurnOf(const Joint& joint, const Rotations& rotations) const {
  glm::quat turn = Turn(joint.to, rotations);
  if (joint.between < 1.0f) turn = glm::slerp(Turn(joint.from, rotations), turn, joint.between);
  // The swing comes first: the twist below turns about the bone and keeps its direction.
  if (joint.end != kNoJoint) {
    const glm::vec3 bone = BoneVector(joint, rotations);
    if (glm::length(bone) > kMinBoneLength) turn = Swing(turn * joint.direction, bone) * turn;
  }
  if (joint.twist < 1.0f) {
    // The twist relative to the joint above: shoulders and hips must not add theirs. Removes the
    // share that belongs to joints further down the bone.
    const glm::quat relative = glm::conjugate(Turn(joint.from, rotations)) * turn;
    const float angle = TwistAngle(relative, joint.direction);
    turn = turn * glm::angleAxis((joint.twist - 1.0f) * angle, joint.direction);
  }
  return turn;
}

glm::vec3 BodyRetarget::HipsPlace(std::span<const Transform> pose) const {
  const glm::vec3 place(ModelOf(source_hips_, source_parents_, pose)[3]);
  // A root that rests off the floor states no position unless it moves.
  if (rests_off_floor_ && glm::distance(place, source_rest_place_) <= still_) {
    return target_rest_place_;
  }
  return target_origin_ + scale_ * (turn_ * (place - source_origin_));
}

// The joints above the hips already have their pose, so a position in model space can be expressed
// in the space of the hips' parent.
void BodyRetarget::PlaceHips(std::span<const Transform> source, std::span<Transform> target) const {
  const glm::vec3 place = HipsPlace(source);
  const glm::mat4 above = ModelOf(target_parents_[At(target_hips_)], target_parents_, target);
  target[At(target_hips_)].translation = glm::vec3(glm::inverse(above) * glm::vec4(place, 1.0f));
}

void BodyRetarget::Run(std::span<const Transform> source, std::span<Transform> target) const {
  // Model-space rotations of both skeletons. Fixed arrays on the stack keep this free of
  // allocations.
  Rotations from;
  for (std::size_t i = 0; i < source_parents_.size(); ++i) {
    const int parent = source_parents_[i];
    from[i] = parent == kNoJoint ? source[i].rotation
                                 : glm::normalize(from[At(parent)] * source[i].rotation);
  }
  Rotations to;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const int parent = target_parents_[i];
    const glm::quat above = parent == kNoJoint ? kNoTurn : to[At(parent)];
    if (joints_[i].to == kNoJoint) {
      to[i] = glm::normalize(above * target[i].rotation);
      continue;
    }
    to[i] = glm::normalize(TurnOf(joints_[i], from) * joints_[i].stance);
    target[i].rotation = glm::normalize(glm::conjugate(above) * to[i]);
  }
  if (source_hips_ != kNoJoint && target_hips_ != kNoJoint) PlaceHips(source, target);
}

}  // namespace furrow::wrinkle
