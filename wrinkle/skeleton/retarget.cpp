// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/retarget.h"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/vector_relational.hpp>

#include "wrinkle/skeleton/body_retarget.h"
#include "wrinkle/skeleton/body_stance.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {
namespace {

// The lengths of all bones, or of those to joints that `other` has too.
float SumOfBones(const Skeleton& skeleton, const Skeleton* other) {
  float sum = 0.0f;
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    const int parent = skeleton.joint_parents()[joint];
    if (parent == kNoJoint) continue;
    if (other != nullptr && other->Find(skeleton.joint_names()[joint]) == kNoJoint) continue;
    sum += glm::distance(RestOrigin(skeleton, joint), RestOrigin(skeleton, parent));
  }
  return sum;
}

// A skeleton of roots alone has no bones, but it may have tails.
float SumOfTails(const Skeleton& skeleton) {
  float sum = 0.0f;
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    const glm::vec3 tail(skeleton.rest_model()[joint] * glm::vec4(skeleton.tails()[joint], 0.0f));
    sum += glm::length(tail);
  }
  return sum;
}

// The source joint for each target joint, by alias and then by name.
std::vector<int> MatchJoints(const Skeleton& source, const Skeleton& target,
                             std::span<const std::pair<std::string, std::string>> aliases) {
  std::vector<int> match;
  for (const std::string& name : target.joint_names()) {
    int found = kNoJoint;
    for (const auto& [source_name, target_name] : aliases) {
      if (target_name == name && found == kNoJoint) found = source.Find(source_name);
    }
    match.push_back(found != kNoJoint ? found : source.Find(name));
  }
  return match;
}

// The ratio of sizes over the spans between matched joints. Joints that only one skeleton has, such
// as further spine joints, do not affect it.
float SizeRatio(const Skeleton& source, const Skeleton& target, std::span<const int> match) {
  float source_sum = 0.0f;
  float target_sum = 0.0f;
  for (int joint = 0; joint < target.num_joints(); ++joint) {
    if (match[joint] == kNoJoint) continue;
    int above = target.joint_parents()[joint];
    while (above != kNoJoint && match[above] == kNoJoint) above = target.joint_parents()[above];
    if (above == kNoJoint) continue;
    source_sum += glm::distance(RestOrigin(source, match[joint]), RestOrigin(source, match[above]));
    target_sum += glm::distance(RestOrigin(target, joint), RestOrigin(target, above));
  }
  // No two matched joints are related, so whole sizes must do.
  if (source_sum <= 0.0f || target_sum <= 0.0f) {
    source_sum = SkeletonSize(source, &target);
    target_sum = SkeletonSize(target, &source);
  }
  return source_sum > 0.0f && target_sum > 0.0f ? target_sum / source_sum : 1.0f;
}

// The source joint for each target joint: by role if both skeletons have equally many joints with
// that role; by name for joints without a role on either side.
std::vector<int> PairJoints(const Body& source, const Body& target) {
  std::vector<int> match;
  for (int joint = 0; joint < target.skeleton().num_joints(); ++joint) {
    const JointRole role = target.RoleOf(joint);
    if (role == JointRole::kNone) {
      const int named = source.skeleton().Find(target.skeleton().joint_names()[joint]);
      const bool free = named != kNoJoint && source.RoleOf(named) == JointRole::kNone;
      match.push_back(free ? named : kNoJoint);
      continue;
    }
    const std::span<const int> from = source.Chain(role);
    const std::span<const int> to = target.Chain(role);
    const auto place = std::find(to.begin(), to.end(), joint) - to.begin();
    match.push_back(from.size() == to.size() ? from[place] : kNoJoint);
  }
  return match;
}

// True if the bones of joints with roles have the same lengths to 1%, up to the ratio of sizes.
bool HaveSameShape(const Body& source, const Body& target, std::span<const int> match,
                   float scale) {
  constexpr float kAlike = 0.01f;
  for (int joint = 0; joint < target.skeleton().num_joints(); ++joint) {
    const JointRole role = target.RoleOf(joint);
    if (role == JointRole::kNone || role == JointRole::kHips) continue;
    if (match[joint] == kNoJoint) return false;
    const float own = glm::length(target.skeleton().rest_pose()[joint].translation);
    const float other = glm::length(source.skeleton().rest_pose()[match[joint]].translation);
    if (std::abs(own - scale * other) > kAlike * own) return false;
  }
  return true;
}

// The names of source joints that match no target joint and that are not `read` otherwise (one
// entry per joint).
std::vector<std::string> Unmatched(const Skeleton& source, std::span<const int> match,
                                   std::vector<bool> read) {
  for (const int joint : match) {
    if (joint != kNoJoint) read[joint] = true;
  }
  std::vector<std::string> names;
  for (int i = 0; i < source.num_joints(); ++i) {
    if (!read[i]) names.push_back(source.joint_names()[i]);
  }
  return names;
}

}  // namespace

float SkeletonSize(const Skeleton& skeleton, const Skeleton* other) {
  float size = SumOfBones(skeleton, other);
  if (size <= 0.0f) size = SumOfBones(skeleton, nullptr);
  return size > 0.0f ? size : SumOfTails(skeleton);
}

void Retarget::Plan(const Skeleton& source, const Skeleton& target, std::span<const int> match,
                    std::span<const glm::quat> stance, const glm::quat& turn) {
  num_source_ = static_cast<std::size_t>(source.num_joints());
  // Translations are relative to the parent, so they need the parent's axes.
  const auto above = [&](int joint) {
    const int parent = target.joint_parents()[joint];
    return parent == kNoJoint ? glm::quat(1.0f, 0.0f, 0.0f, 0.0f) : stance[parent];
  };
  for (int i = 0; i < target.num_joints(); ++i) {
    Joint joint;
    joint.rest = target.rest_pose()[i];
    joint.source = match[i];
    if (joint.source != kNoJoint) {
      const Transform& source_rest = source.rest_pose()[joint.source];
      joint.source_rest_inverse = glm::conjugate(glm::normalize(source_rest.rotation));
      joint.to_target = glm::conjugate(stance[i]) * turn * RestRotation(source, joint.source);
      joint.parent_to_target = glm::conjugate(above(i)) * turn *
                               RestRotation(source, source.joint_parents()[joint.source]);
      joint.source_rest_translation = source_rest.translation;
      joint.source_rest_scale = source_rest.scale;
    }
    joints_.push_back(joint);
  }
}

std::optional<RestStance> FindRestStance(const Skeleton& skeleton, const JointRoles& roles) {
  const Body body(skeleton, roles);
  const auto turn = TurnOfAxes(body);
  if (!turn) return std::nullopt;
  glm::vec3 toes(0.0f);
  for (const JointRole foot : {JointRole::kLeftFoot, JointRole::kRightFoot}) {
    toes += body.RestSpan(foot, BoneEnd(foot)).value_or(glm::vec3(0.0f));
    // Each leg by itself: where one points up and the other down, their sum says nothing.
    const glm::vec3 leg = *turn * body.RestSpan(JointRole::kHips, foot).value_or(glm::vec3(0.0f));
    if (leg.y > 0.5f * glm::length(leg)) return RestStance{.is_folded = true};
  }
  const glm::vec3 ahead = *turn * toes;
  return RestStance{.turn = *turn, .toes_point_back = ahead.z < -0.5f * glm::length(ahead)};
}

std::optional<glm::vec3> UpFromLimbs(const Skeleton& skeleton, const JointRoles& roles) {
  return UpOfLimbs(Body(skeleton, roles));
}

Retarget Retarget::Create(const Skeleton& source, const Skeleton& target,
                          std::span<const std::pair<std::string, std::string>> aliases) {
  const std::vector<int> match = MatchJoints(source, target, aliases);
  Retarget retarget;
  retarget.scale_ = SizeRatio(source, target, match);
  retarget.Plan(source, target, match, target.rest_model_rotations(),
                glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
  retarget.unmatched_ =
      Unmatched(source, match, std::vector<bool>(source.joint_names().size(), false));
  return retarget;
}

Retarget Retarget::Create(const Skeleton& source, const JointRoles& source_roles,
                          const Skeleton& target, const JointRoles& target_roles,
                          std::optional<float> toes_height) {
  const auto fits = [](const JointRoles& roles, const Skeleton& skeleton) {
    return !roles.empty() && roles.size() == static_cast<std::size_t>(skeleton.num_joints());
  };
  if (!fits(source_roles, source) || !fits(target_roles, target)) return Create(source, target);
  const Body from(source, source_roles);
  const Body to(target, target_roles);
  BodyRetarget::Fit fit;
  fit.turn = QuarterTurn(from, to);
  // The stance depends on the quarter turn, the shape on the scale: the order matters.
  fit.stance = AlignedStance(from, to, fit.turn);
  fit.toes_height = toes_height;

  Retarget retarget;
  const std::vector<int> paired = PairJoints(from, to);
  const float source_leg = LegLength(from, to);
  const float target_leg = LegLength(to, from);
  retarget.scale_ = source_leg > 0.0f && target_leg > 0.0f ? target_leg / source_leg
                                                           : SizeRatio(source, target, paired);
  fit.scale = retarget.scale_;
  fit.same_shape = HaveSameShape(from, to, paired, retarget.scale_);
  const auto body = std::make_shared<const BodyRetarget>(from, to, fit);
  // BodyRetarget sets the joints that it carries, so Carry() leaves them at rest. In bodies of the
  // same shape, Carry() still moves their translations and scales.
  std::vector<int> match = paired;
  for (int i = 0; i < target.num_joints(); ++i) {
    if (!fit.same_shape && body->Carries(i)) match[i] = kNoJoint;
  }
  retarget.Plan(source, target, match, fit.stance, fit.turn);
  retarget.body_ = body;
  retarget.unmatched_ = Unmatched(source, paired, body->ReadJoints());
  return retarget;
}

Transform Retarget::Carry(const Joint& joint, const Transform& source) const {
  Transform result = joint.rest;
  // The departure from rest in the source joint's own axes. `to_target` expresses it in the
  // target's axes.
  const glm::quat departure = joint.source_rest_inverse * source.rotation;
  result.rotation = glm::normalize(joint.rest.rotation * joint.to_target * departure *
                                   glm::conjugate(joint.to_target));
  result.translation +=
      joint.parent_to_target * (source.translation - joint.source_rest_translation) * scale_;
  if (source.scale != joint.source_rest_scale &&
      glm::all(glm::notEqual(joint.source_rest_scale, glm::vec3(0.0f)))) {
    // The diagonal of Q S inverse(Q): a scale along the source's axes, expressed in the target's
    // axes.
    glm::mat3 squared = glm::mat3_cast(joint.to_target);
    for (int column = 0; column < 3; ++column) squared[column] *= squared[column];
    result.scale *= squared * (source.scale / joint.source_rest_scale);
  }
  return result;
}

JobStatus Retarget::Run(std::span<const Transform> source, std::span<Transform> target) const {
  if (source.size() < num_source_ || target.size() < joints_.size()) {
    return JobStatus::kSizeMismatch;
  }
  if (!AllFinite(source.first(num_source_))) return JobStatus::kNonFinite;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    target[i] = joint.source == kNoJoint ? joint.rest : Carry(joint, source[joint.source]);
  }
  if (body_ != nullptr) body_->Run(source, target);
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle
