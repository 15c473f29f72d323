// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_reference_pose.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/ascii.h"
#include "base/status.h"
#include "wrinkle/shapes/head_turn.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::rig {
namespace {

using wrinkle::JointDelta;
using wrinkle::PoseFrame;
using wrinkle::ReferencePose;
using wrinkle::Skeleton;
using wrinkle::Transform;

constexpr float kLeastRadians = 1e-5f;
constexpr float kLeastTranslation = 1e-6f;  // of the skeleton's size
constexpr float kLeastCoefficient = 1e-3f;

// The angle of the shorter turn, in radians.
float Angle(const glm::quat& q) {
  return 2.0f * std::atan2(glm::length(glm::vec3(q.x, q.y, q.z)), std::abs(q.w));
}

// q and -q are the same rotation. A w of 0 or more gives the shorter turn.
glm::quat ShorterWay(const glm::quat& q) { return q.w < 0.0f ? -q : q; }

// exp(weight * log(q)), by the shorter rotation.
glm::quat Scaled(const glm::quat& rotation, float weight) {
  if (weight == 1.0f) return rotation;
  const glm::quat q = ShorterWay(rotation);
  const glm::vec3 v(q.x, q.y, q.z);
  const float sine = glm::length(v);
  // Too small a turn for an axis.
  if (sine < 1e-9f) return {1.0f, 0.0f, 0.0f, 0.0f};
  const float half = std::atan2(sine, q.w) * weight;
  return {std::cos(half), v * (std::sin(half) / sine)};
}

// Frames come from recordings. Every number must be finite before it enters a rig.
Status CheckPose(const PoseFrame& frame, const PoseFrame& like) {
  const Skeleton& skeleton = like.skeleton;
  if (static_cast<int>(frame.pose.joints.size()) != skeleton.num_joints()) {
    return {StatusCode::kInvalidArgument,
            "the frame has " + std::to_string(frame.pose.joints.size()) +
                " joints, but its skeleton has " + std::to_string(skeleton.num_joints())};
  }
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    if (!wrinkle::IsValid(frame.pose.joints[j])) {
      return {StatusCode::kNonFinite,
              "the transform of joint '" + skeleton.joint_names()[j] + "' is invalid"};
    }
  }
  const std::span<const std::string> names = like.blend_shape_names;
  if (names.empty()) return {};
  if (frame.pose.blend_shapes.size() != names.size()) {
    return {StatusCode::kInvalidArgument,
            "the frame has " + std::to_string(frame.pose.blend_shapes.size()) +
                " blend shapes, but " + std::to_string(names.size()) + " names"};
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!std::isfinite(frame.pose.blend_shapes[i])) {
      return {StatusCode::kNonFinite,
              "the coefficient of blend shape '" + names[i] + "' is invalid"};
    }
  }
  return {};
}

// `rest` with the departure of `moved` from `still`, in the axes of `still`.
Transform MovedFrom(const Transform& rest, const Transform& still, const Transform& moved) {
  Transform result = moved;
  result.rotation = glm::normalize(rest.rotation * glm::inverse(still.rotation) * moved.rotation);
  result.translation = rest.translation + (moved.translation - still.translation);
  return result;
}

// Joints of a pose that move with an anchor without hanging from it.
class FlatPose {
 public:
  // `still` and `moved`: local poses of `skeleton`.
  FlatPose(const Skeleton& skeleton, std::span<const Transform> still,
           std::span<const Transform> moved)
      : skeleton_(skeleton),
        rest_(ModelOf(skeleton.rest_pose())),
        still_(ModelOf(still)),
        moved_(ModelOf(moved)) {
    for (std::size_t j = 0; j < moved.size(); ++j) {
      locals_.push_back(MovedFrom(skeleton.rest_pose()[j], still[j], moved[j]));
    }
    reference_ = ModelOf(locals_);
  }

  // Replaces the transforms of such joints in both poses: they move from the skeleton's rest pose
  // as they have moved in the anchor's space.
  void Correct(const PoseAnchors& anchors, std::vector<Transform>* still,
               std::vector<Transform>* moved) {
    for (int j = 0; j < skeleton_.num_joints(); ++j) {
      const auto own = static_cast<std::size_t>(j);
      const int parent = skeleton_.joint_parents()[own];
      const auto found = anchors.find(skeleton_.joint_names()[own]);
      const int anchor = found == anchors.end() ? wrinkle::kNoJoint : skeleton_.Find(found->second);
      if (anchor == wrinkle::kNoJoint || !GoesWith(anchor, j)) {
        // The parent may have changed.
        reference_[own] = In(reference_, parent, locals_[own]);
        continue;
      }
      const Transform in_anchor =
          MovedFrom(Seen(rest_, anchor, j), Seen(still_, anchor, j), Seen(moved_, anchor, j));
      reference_[own] = In(reference_, anchor, in_anchor);
      (*still)[own] = skeleton_.rest_pose()[own];
      (*moved)[own] = Seen(reference_, parent, j);
    }
  }

 private:
  // Model space. Without scales, which faces do not have.
  using Model = std::vector<Transform>;

  // `local`, which is in the space of joint `space`, in model space.
  static Transform In(const Model& model, int space, const Transform& local) {
    if (space == wrinkle::kNoJoint) return local;
    const Transform& base = model[static_cast<std::size_t>(space)];
    Transform result = local;
    result.rotation = glm::normalize(base.rotation * local.rotation);
    result.translation = base.translation + base.rotation * local.translation;
    return result;
  }
  // Joint `joint` in the space of joint `space`.
  static Transform Seen(const Model& model, int space, int joint) {
    const Transform& own = model[static_cast<std::size_t>(joint)];
    if (space == wrinkle::kNoJoint) return own;
    const Transform& base = model[static_cast<std::size_t>(space)];
    Transform result = own;
    result.rotation = glm::normalize(glm::inverse(base.rotation) * own.rotation);
    result.translation = glm::inverse(base.rotation) * (own.translation - base.translation);
    return result;
  }
  [[nodiscard]] Model ModelOf(std::span<const Transform> locals) const {
    Model model(locals.begin(), locals.end());
    for (std::size_t j = 0; j < model.size(); ++j) {
      model[j] = In(model, skeleton_.joint_parents()[j], locals[j]);
    }
    return model;
  }

  // How far the joint's origin and tail are from their places at rest, in the space of `space`.
  [[nodiscard]] float Departure(int space, int joint) const {
    const Transform from = Seen(rest_, space, joint);
    const Transform to = Seen(still_, space, joint);
    const glm::vec3& tail = skeleton_.tails()[static_cast<std::size_t>(joint)];
    return glm::distance(from.translation, to.translation) +
           glm::distance(from.translation + from.rotation * tail,
                         to.translation + to.rotation * tail);
  }
  // True if the joint has gone with the anchor to the rest frame, and not with its own parent.
  [[nodiscard]] bool GoesWith(int anchor, int joint) const {
    if (skeleton_.IsAncestor(anchor, joint) || skeleton_.IsAncestor(joint, anchor)) return false;
    const int parent = skeleton_.joint_parents()[static_cast<std::size_t>(joint)];
    return Departure(anchor, joint) < Departure(parent, joint);
  }

  const Skeleton& skeleton_;
  Model rest_;
  Model still_;
  Model moved_;
  Model locals_;  // the reference pose, local: the skeleton's rest pose with all departures
  Model reference_;
};

// Names that differ only in case are one blend shape, and its first coefficient counts, as in
// wrinkle::BindContext.
std::vector<wrinkle::ShapeValue> ShapesOf(const PoseFrame& frame, const PoseFrame* rest) {
  std::vector<wrinkle::ShapeValue> shapes;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < frame.blend_shape_names.size(); ++i) {
    const std::string& name = frame.blend_shape_names[i];
    if (name.empty() || wrinkle::IsTrackerAngle(name)) continue;
    if (!seen.insert(AsciiLower(name)).second) continue;
    const float still = rest != nullptr ? rest->pose.blend_shapes[i] : 0.0f;
    const float value = frame.pose.blend_shapes[i] - still;
    if (std::abs(value) >= kLeastCoefficient) shapes.push_back({name, value});
  }
  return shapes;
}

// The shapes of a mix, in the order of their first appearance.
class ShapeSum {
 public:
  void Add(const std::vector<wrinkle::ShapeValue>& part, float weight) {
    for (const wrinkle::ShapeValue& shape : part) {
      const auto [place, is_new] =
          places_.try_emplace(AsciiLower(shape.blend_shape), shapes_.size());
      if (is_new) shapes_.push_back({shape.blend_shape, 0.0f});
      shapes_[place->second].value += weight * shape.value;
    }
  }
  [[nodiscard]] std::vector<wrinkle::ShapeValue> Take() { return std::move(shapes_); }

 private:
  std::vector<wrinkle::ShapeValue> shapes_;
  std::unordered_map<std::string, std::size_t> places_;  // by lower case
};

}  // namespace

glm::quat FromEulerDegrees(const glm::vec3& degrees) {
  const glm::vec3 radians = glm::radians(degrees);
  return glm::angleAxis(radians.z, glm::vec3(0, 0, 1)) *
         glm::angleAxis(radians.y, glm::vec3(0, 1, 0)) *
         glm::angleAxis(radians.x, glm::vec3(1, 0, 0));
}

Result<ReferencePose> ReferencePoseFromFrame(std::string name, const PoseFrame& frame,
                                             const PoseFrame* rest, const PoseAnchors& anchors) {
  const Skeleton& skeleton = frame.skeleton;
  FURROW_RETURN_IF_ERROR(CheckPose(frame, frame));
  if (rest != nullptr) {
    FURROW_RETURN_IF_ERROR(CheckPose(*rest, frame));
  }
  ReferencePose pose;
  pose.name = std::move(name);
  pose.source_size = wrinkle::SkeletonSize(skeleton);
  pose.shapes = ShapesOf(frame, rest);

  const std::span<const Transform> at_rest =
      rest != nullptr ? std::span<const Transform>(rest->pose.joints) : skeleton.rest_pose();
  std::vector<Transform> stills(at_rest.begin(), at_rest.end());
  std::vector<Transform> moveds = frame.pose.joints;
  if (rest != nullptr && !anchors.empty()) {
    FlatPose(skeleton, stills, moveds).Correct(anchors, &stills, &moveds);
  }
  const std::span<const glm::quat> axes = skeleton.rest_model_rotations();
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const Transform& still = stills[j];
    const Transform& moved = moveds[j];
    const int parent = skeleton.joint_parents()[j];
    const glm::quat above = parent < 0 ? glm::quat(1, 0, 0, 0) : axes[parent];
    // The departure in the joint's own axes, expressed in model axes of the skeleton's rest pose,
    // as JointDelta defines them. The rotations of `rest` must not enter here: they contain the
    // performer's heading and the tilt of the head.
    const glm::quat& g = axes[j];
    JointDelta delta;
    delta.joint = skeleton.joint_names()[j];
    delta.rotation = ShorterWay(
        glm::normalize(g * glm::inverse(still.rotation) * moved.rotation * glm::inverse(g)));
    delta.translation = above * (moved.translation - still.translation);
    // Recordings repeat the rest pose in rounded numbers. Joints that only differ by rounding stay
    // out of the pose, so that rigs stay small and blends exact.
    const bool turns = Angle(delta.rotation) > kLeastRadians;
    const bool shifts = glm::length(delta.translation) > kLeastTranslation * pose.source_size;
    if (!turns) delta.rotation = {1.0f, 0.0f, 0.0f, 0.0f};
    if (!shifts) delta.translation = glm::vec3(0.0f);
    if (turns || shifts) pose.joints.push_back(std::move(delta));
  }
  return pose;
}

ReferencePose MixReferencePoses(std::string name, std::span<const WeightedPose> parts) {
  ReferencePose mix;
  mix.name = std::move(name);
  // The units of the first part that states a size.
  for (const WeightedPose& part : parts) {
    if (mix.source_size == 0.0f) mix.source_size = part.pose->source_size;
  }
  std::unordered_map<std::string, std::size_t> places;
  ShapeSum shapes;
  for (const WeightedPose& part : parts) {
    // Parts without a size are in units of the bound skeleton, whatever its size. Their
    // translations cannot be converted here, and stay apart if the mix states a size.
    const float size = part.pose->source_size;
    const bool apart = size == 0.0f && mix.source_size > 0.0f;
    const float scale = size > 0.0f ? mix.source_size / size : 1.0f;
    for (const JointDelta& delta : part.pose->joints) {
      // Joints keep the order of their first appearance, so that files do not change between runs.
      const auto [place, added] = places.emplace(delta.joint, mix.joints.size());
      if (added) mix.joints.push_back({.joint = delta.joint});
      JointDelta& sum = mix.joints[place->second];
      sum.rotation = Scaled(delta.rotation, part.weight) * sum.rotation;
      glm::vec3& translation = apart ? sum.unscaled_translation : sum.translation;
      translation += delta.translation * (part.weight * scale);
      sum.unscaled_translation += delta.unscaled_translation * part.weight;
    }
    shapes.Add(part.pose->shapes, part.weight);
  }
  mix.shapes = shapes.Take();
  for (JointDelta& sum : mix.joints) {
    sum.rotation = ShorterWay(sum.rotation);
    // A mix of one pose stays the same to the bit, so that files do not change when they are
    // written again.
    const float square = glm::dot(sum.rotation, sum.rotation);
    if (std::abs(square - 1.0f) > 1e-6f) sum.rotation = glm::normalize(sum.rotation);
  }
  return mix;
}

}  // namespace furrow::rig
