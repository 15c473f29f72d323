// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/body_stance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "wrinkle/skeleton/direction.h"

namespace furrow::wrinkle {
namespace {

using enum JointRole;

// Sine of the steepest slope of a foot that counts as flat on the floor at rest.
constexpr float kSteepFoot = 0.8f;

std::size_t Index(JointRole role) { return static_cast<std::size_t>(role); }

// An orthonormal frame from one direction and a second, less certain direction across it.
std::optional<glm::mat3> Frame(const std::optional<glm::vec3>& along,
                               const std::optional<glm::vec3>& aside) {
  if (!along || !aside) return std::nullopt;
  const glm::vec3 x = glm::normalize(*along);
  const glm::vec3 across = *aside - glm::dot(*aside, x) * x;
  // Within 6 degrees of parallel: the second direction would only add noise.
  if (glm::length(across) < 0.1f * glm::length(*aside)) return std::nullopt;
  const glm::vec3 y = glm::normalize(across);
  return glm::mat3(x, y, glm::cross(x, y));
}

// The signed model axis nearest to `v`, except axis `but`.
glm::vec3 NearestAxis(const glm::vec3& v, int but = -1) {
  int best = but == 0 ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != but && std::abs(v[axis]) > std::abs(v[best])) best = axis;
  }
  glm::vec3 result(0.0f);
  result[best] = v[best] < 0.0f ? -1.0f : 1.0f;
  return result;
}

// Away from the ends of the limbs, or else from the hips to the highest joint of the trunk that
// exists.
std::optional<glm::vec3> Up(const Body& body) {
  if (const auto up = UpOfLimbs(body)) return up;
  for (const JointRole top : {kHead, kNeck, kUpperChest, kChest, kSpine}) {
    if (const auto span = body.RestSpan(kHips, top)) return span;
  }
  // A tracker of faces has no trunk.
  return body.RestSpan(kNeck, kHead);
}

// From right to left, by the first pair of joints that exists on both sides.
std::optional<glm::vec3> Leftward(const Body& body) {
  for (const JointRole role : {kRightUpperLeg, kRightUpperArm, kRightShoulder, kRightEye}) {
    if (const auto span = body.RestSpan(role, MirrorOf(role))) return span;
  }
  return std::nullopt;
}

// The left, up and forward directions, each along a model axis.
std::optional<glm::mat3> BodyAxes(const Body& body) {
  const auto up = Up(body);
  const auto left = Leftward(body);
  if (!up || !left) return std::nullopt;
  // Snapping to axes ignores a lean of the rest pose: only files with other axes are turned, never
  // stances.
  const glm::vec3 y = NearestAxis(*up);
  int up_axis = 0;
  while (y[up_axis] == 0.0f) ++up_axis;
  const glm::vec3 x = NearestAxis(*left, up_axis);
  return glm::mat3(x, y, glm::cross(x, y));
}

// The swing from the target's bone, as aligned so far, to the direction of the source's bone.
glm::quat AlignBone(const Body& source, const Body& target, JointRole role, const glm::quat& turn,
                    const glm::quat& so_far) {
  const auto wanted = source.RestSpan(role, BoneEnd(role));
  const auto own = target.RestSpan(role, BoneEnd(role));
  if (!wanted || !own) return so_far;
  return Swing(so_far * *own, turn * *wanted) * so_far;
}

// Also aligns the palms of hands with known index and little fingers.
glm::quat AlignHand(const Body& source, const Body& target, JointRole hand, const glm::quat& turn,
                    const glm::quat& so_far) {
  const bool left = hand == kLeftHand;
  const JointRole index = left ? kLeftIndexProximal : kRightIndexProximal;
  const JointRole little = left ? kLeftLittleProximal : kRightLittleProximal;
  const auto wanted = Frame(source.RestSpan(hand, BoneEnd(hand)), source.RestSpan(little, index));
  const auto own = Frame(target.RestSpan(hand, BoneEnd(hand)), target.RestSpan(little, index));
  if (!wanted || !own) return AlignBone(source, target, hand, turn, so_far);
  return turn * glm::quat_cast(*wanted * glm::transpose(*own));
}

// Feet that are flat at rest only receive a heading, because the height of the ankle above the toe
// joint is a property of the rig. Other feet keep `so_far`.
glm::quat AlignFoot(const Body& source, const Body& target, JointRole foot, const glm::quat& turn,
                    const glm::quat& so_far) {
  const glm::quat flat(1.0f, 0.0f, 0.0f, 0.0f);
  const auto wanted = source.RestSpan(foot, BoneEnd(foot));
  const auto own = target.RestSpan(foot, BoneEnd(foot));
  if (!wanted || !own) return flat;
  const glm::vec3 up = UpAxis(target);
  const glm::vec3 to = glm::normalize(turn * *wanted);
  const glm::vec3 from = glm::normalize(*own);
  if (std::abs(glm::dot(to, up)) > kSteepFoot || std::abs(glm::dot(from, up)) > kSteepFoot) {
    return AlignBone(source, target, foot, turn, so_far);
  }
  return Swing(from - glm::dot(from, up) * up, to - glm::dot(to, up) * up);
}

}  // namespace

glm::quat Swing(const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 a = glm::normalize(from);
  const glm::vec3 b = glm::normalize(to);
  // (1 + cos, sin * axis) is twice cos(angle / 2) times the quaternion of the angle, so a
  // normalisation replaces all trigonometry. It fails for opposite directions, where any axis
  // across will do.
  const float cosine = glm::dot(a, b);
  if (cosine > -0.999999f) {
    const glm::vec3 axis = glm::cross(a, b);
    return glm::normalize(glm::quat(1.0f + cosine, axis.x, axis.y, axis.z));
  }
  const glm::vec3 other = std::abs(a.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 axis = glm::normalize(glm::cross(a, other));
  return {0.0f, axis.x, axis.y, axis.z};
}

Body::Body(const Skeleton& skeleton, const JointRoles& roles)
    : skeleton_(&skeleton), roles_(&roles) {
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    const JointRole role = RoleOf(joint);
    if (role != kNone) chains_[Index(role)].push_back(joint);
  }
}

std::span<const int> Body::Chain(JointRole role) const { return chains_[Index(role)]; }

int Body::First(JointRole role) const {
  return Chain(role).empty() ? kNoJoint : Chain(role).front();
}

int Body::Last(JointRole role) const { return Chain(role).empty() ? kNoJoint : Chain(role).back(); }

JointRole Body::RoleOf(int joint) const {
  const auto i = static_cast<std::size_t>(joint);
  return i < roles_->size() ? (*roles_)[i] : kNone;
}

glm::vec3 Body::RestOrigin(int joint) const {
  return glm::vec3(skeleton_->rest_model()[static_cast<std::size_t>(joint)][3]);
}

std::optional<glm::vec3> Body::RestSpan(JointRole from, JointRole to) const {
  const int a = First(from);
  const int b = First(to);
  if (a == kNoJoint || b == kNoJoint) return std::nullopt;
  const glm::vec3 span = RestOrigin(b) - RestOrigin(a);
  if (glm::length(span) < kMinBoneLength) return std::nullopt;
  return span;
}

JointRole BoneEnd(JointRole role) {
  switch (role) {
    case kLeftUpperArm: return kLeftLowerArm;
    case kLeftLowerArm: return kLeftHand;
    case kLeftHand: return kLeftMiddleProximal;
    case kLeftUpperLeg: return kLeftLowerLeg;
    case kLeftLowerLeg: return kLeftFoot;
    case kLeftFoot: return kLeftToes;
    case kLeftThumbMetacarpal: return kLeftThumbProximal;
    case kLeftThumbProximal: return kLeftThumbDistal;
    case kLeftIndexProximal: return kLeftIndexIntermediate;
    case kLeftIndexIntermediate: return kLeftIndexDistal;
    case kLeftMiddleProximal: return kLeftMiddleIntermediate;
    case kLeftMiddleIntermediate: return kLeftMiddleDistal;
    case kLeftRingProximal: return kLeftRingIntermediate;
    case kLeftRingIntermediate: return kLeftRingDistal;
    case kLeftLittleProximal: return kLeftLittleIntermediate;
    case kLeftLittleIntermediate: return kLeftLittleDistal;
    default: break;
  }
  // The right side mirrors the left. The middle of the body and the ends of limbs have no bone.
  return role > MirrorOf(role) ? MirrorOf(BoneEnd(MirrorOf(role))) : kNone;
}

glm::quat QuarterTurn(const Body& source, const Body& target) {
  const auto from = BodyAxes(source);
  const auto to = BodyAxes(target);
  if (!from || !to) return {1.0f, 0.0f, 0.0f, 0.0f};
  return glm::normalize(glm::quat_cast(*to * glm::transpose(*from)));
}

std::optional<glm::quat> TurnOfAxes(const Body& body) {
  const auto axes = BodyAxes(body);
  if (!axes) return std::nullopt;
  // Exactly the identity for a body in Furrow's axes, so that nothing changes for it.
  if (*axes == glm::mat3(1.0f)) return glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
  return glm::normalize(glm::quat_cast(glm::transpose(*axes)));
}

std::optional<glm::vec3> UpOfLimbs(const Body& body) {
  constexpr std::array kLimbs = {std::pair(kLeftUpperLeg, kLeftToes),
                                 std::pair(kLeftUpperArm, kLeftHand)};
  std::array<glm::vec3, 4> limbs{};
  glm::vec3 down(0.0f);
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    const auto& [start, end] = kLimbs[i / 2];
    const bool left = i % 2 == 0;
    auto limb = left ? body.RestSpan(start, end) : body.RestSpan(MirrorOf(start), MirrorOf(end));
    if (!limb && end == kLeftToes) {
      limb = left ? body.RestSpan(start, kLeftFoot) : body.RestSpan(MirrorOf(start), kRightFoot);
    }
    if (!limb) return std::nullopt;
    limbs[i] = glm::normalize(*limb);
    down += limbs[i];
  }
  const auto is_down = [&](const glm::vec3& direction) { return PointAlike(direction, down); };
  if (!std::all_of(limbs.begin(), limbs.end(), is_down)) return std::nullopt;
  const glm::vec3 trunk = body.RestSpan(kLeftUpperLeg, kLeftUpperArm).value_or(glm::vec3(0.0f)) +
                          body.RestSpan(kRightUpperLeg, kRightUpperArm).value_or(glm::vec3(0.0f));
  if (is_down(trunk)) return std::nullopt;
  return -glm::normalize(down);
}

std::vector<glm::quat> AlignedStance(const Body& source, const Body& target,
                                     const glm::quat& turn) {
  const Skeleton& skeleton = target.skeleton();
  std::vector<glm::quat> aligned;  // the turn away from target's rest pose, model space
  std::vector<glm::quat> stance;
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    // A joint without a role follows its parent's alignment.
    const int parent = skeleton.joint_parents()[static_cast<std::size_t>(joint)];
    glm::quat turned = parent == kNoJoint ? glm::quat(1.0f, 0.0f, 0.0f, 0.0f)
                                          : aligned[static_cast<std::size_t>(parent)];
    const JointRole role = target.RoleOf(joint);
    if (role != kNone && joint == target.First(role)) {
      if (role == kLeftFoot || role == kRightFoot) {
        turned = AlignFoot(source, target, role, turn, turned);
      } else if (role == kLeftHand || role == kRightHand) {
        turned = AlignHand(source, target, role, turn, turned);
      } else {
        turned = AlignBone(source, target, role, turn, turned);
      }
    }
    aligned.push_back(turned);
    stance.push_back(
        glm::normalize(turned * skeleton.rest_model_rotations()[static_cast<std::size_t>(joint)]));
  }
  return stance;
}

float LegLength(const Body& body, const Body& other) {
  const glm::vec3 up = UpAxis(body);
  float sum = 0.0f;
  int num = 0;
  for (const bool left : {true, false}) {
    const auto side = [left](JointRole role) { return left ? role : MirrorOf(role); };
    const auto hip = body.RestSpan(kHips, side(kLeftUpperLeg));
    const auto thigh = body.RestSpan(side(kLeftUpperLeg), side(kLeftLowerLeg));
    const auto shin = body.RestSpan(side(kLeftLowerLeg), side(kLeftFoot));
    if (!hip || !thigh || !shin) continue;
    sum += std::abs(glm::dot(*hip, up)) + glm::length(*thigh) + glm::length(*shin);
    const auto foot = body.RestSpan(side(kLeftFoot), side(kLeftToes));
    if (foot && other.RestSpan(side(kLeftFoot), side(kLeftToes))) {
      sum += std::abs(glm::dot(*foot, up));
    }
    ++num;
  }
  return num == 0 ? 0.0f : sum / static_cast<float>(num);
}

glm::vec3 UpAxis(const Body& body) {
  const auto up = Up(body);
  return up ? NearestAxis(*up) : glm::vec3(0.0f, 1.0f, 0.0f);
}

}  // namespace furrow::wrinkle
