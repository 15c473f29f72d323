// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/bind_context.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/ascii.h"
#include "base/status.h"
#include "wrinkle/drivers/reference_pose.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

void AddOnce(const std::string& name, std::vector<std::string>* list) {
  if (std::find(list->begin(), list->end(), name) == list->end()) list->push_back(name);
}

}  // namespace

BindContext::BindContext(const Rig& rig, const Skeleton& skeleton,
                         std::span<const std::string> blend_shape_names, const BindOptions& options,
                         JointChains* chains)
    : rig_(rig),
      skeleton_(skeleton),
      blend_shape_names_(blend_shape_names),
      options_(options),
      chains_(chains),
      size_(SkeletonSize(skeleton)) {}

Status BindContext::ResolveAnchorAndPoses() {
  if (!rig_.anchor.empty()) {
    const bool needed = std::any_of(rig_.drivers.begin(), rig_.drivers.end(),
                                    [](const Driver& d) { return d.kind == Driver::Kind::kPose; });
    if (needed) {
      Result<int> anchor = Joint("the rig", "anchor", rig_.anchor);
      FURROW_RETURN_IF_ERROR(anchor);
      anchor_ = *anchor;
      anchor_missing_ = anchor_ == kNoJoint;
    }
  }
  for (const ReferencePose& pose : rig_.reference_poses) {
    std::vector<Transform> locals(skeleton_.rest_pose().begin(), skeleton_.rest_pose().end());
    FURROW_RETURN_IF_ERROR(ApplyReferencePose(pose, &locals));
    reference_locals_.push_back(std::move(locals));
  }
  return {};
}

Status BindContext::ApplyReferencePose(const ReferencePose& pose, std::vector<Transform>* locals) {
  const float scale = ReferencePoseScale(pose, skeleton_);
  for (const JointDelta& delta : pose.joints) {
    if (IsRest(delta)) continue;
    const Result<int> joint = Joint("reference pose '" + pose.name + "'", "joint", delta.joint);
    FURROW_RETURN_IF_ERROR(joint);
    if (*joint == kNoJoint) continue;
    ApplyJointDelta(delta, skeleton_, *joint, scale, &(*locals)[*joint]);
  }
  return {};
}

Result<int> BindContext::Joint(std::string_view whose, std::string_view field,
                               const std::string& name) {
  int joint = skeleton_.Find(name);
  for (const auto& [own, theirs] : options_.aliases) {
    if (joint == kNoJoint && own == name) joint = skeleton_.Find(theirs);
  }
  if (joint != kNoJoint) return joint;
  if (!options_.allow_missing) {
    return Status(StatusCode::kNotFound, std::string(whose) + ": " + std::string(field) +
                                             " names joint '" + name +
                                             "', which the skeleton does not have");
  }
  AddOnce(name, &missing_joints_);
  return kNoJoint;
}

Result<int> BindContext::BlendShape(std::string_view whose, const std::string& name) {
  for (std::size_t i = 0; i < blend_shape_names_.size(); ++i) {
    if (EqualsIgnoreCase(blend_shape_names_[i], name)) return static_cast<int>(i);
  }
  // A rig that reads joints, too, is not let down by a stream that has joints alone.
  const bool reads_joints =
      std::any_of(rig_.drivers.begin(), rig_.drivers.end(),
                  [](const Driver& driver) { return driver.kind != Driver::Kind::kBlendShape; });
  if (!options_.allow_missing && !(blend_shape_names_.empty() && reads_joints)) {
    return Status(StatusCode::kNotFound,
                  std::string(whose) + ": blend shape '" + name + "' is not among the stream's");
  }
  AddOnce(name, &missing_blend_shapes_);
  return -1;
}

Status BindContext::Unusable(std::string_view whose, std::string_view why) {
  std::string what = std::string(whose) + ": " + std::string(why);
  if (!options_.allow_missing) return {StatusCode::kInvalidArgument, std::move(what)};
  Warn(std::move(what) + "; it rests at 0");
  return {};
}

const std::vector<Transform>* BindContext::ReferenceLocals(std::string_view name) const {
  for (std::size_t i = 0; i < rig_.reference_poses.size(); ++i) {
    if (rig_.reference_poses[i].name == name) return &reference_locals_[i];
  }
  return nullptr;
}

glm::vec3 Direction(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > kLeastLength ? v / length : glm::vec3(0.0f);
}

glm::vec3 ToJointAxes(const Skeleton& skeleton, int joint, const glm::vec3& direction) {
  if (joint == kNoJoint) return direction;
  return glm::conjugate(skeleton.rest_model_rotations()[joint]) * direction;
}

}  // namespace furrow::wrinkle
