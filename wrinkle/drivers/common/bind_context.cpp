// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/common/bind_context.h"

#include <algorithm>

#include "base/ascii.h"
#include "base/status.h"

namespace furrow::wrinkle {
namespace {

void AddOnce(const std::string& name, std::vector<std::string>* list) {
  if (std::find(list->begin(), list->end(), name) == list->end()) list->push_back(name);
}

}  // namespace

BindContext::BindContext(const BindSource& source, const Skeleton& skeleton,
                         const BindOptions& options, JointChains* chains)
    : source_(source),
      skeleton_(skeleton),
      options_(options),
      turned_(options.turn != glm::quat(1.0f, 0.0f, 0.0f, 0.0f)),
      chains_(chains),
      size_(SkeletonSizeBy(source.size_reference, skeleton)),
      rest_locals_(skeleton.rest_pose().begin(), skeleton.rest_pose().end()) {}

Status BindContext::ResolveAnchorAndPoses() {
  if (!source_.anchor.empty()) {
    Result<int> anchor = Joint("the rig", "anchor", source_.anchor);
    FURROW_RETURN_IF_ERROR(anchor);
    anchor_ = *anchor;
    anchor_missing_ = anchor_ == kNoJoint;
  }
  // Every reference pose is a full local pose on this skeleton, so drivers can measure it like a
  // live pose.
  for (const ReferencePose& pose : source_.reference_poses) {
    std::vector<PreciseTransform> locals = rest_locals_;
    // Drivers of blend shapes alone need no joint, though captured poses have them.
    if (source_.reads_joints) FURROW_RETURN_IF_ERROR(ApplyPose(pose, &locals));
    reference_locals_.push_back(std::move(locals));
  }
  return {};
}

glm::quat BindContext::RestRotationInPose(int joint) const {
  const glm::quat& rest = skeleton_.rest_pose()[joint].rotation;
  const bool is_root = skeleton_.joint_parents()[joint] == kNoJoint;
  return glm::normalize(turned_ && is_root ? glm::conjugate(options_.turn) * rest : rest);
}

Status BindContext::ApplyPose(const ReferencePose& pose, std::vector<PreciseTransform>* locals) {
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

Result<int> BindContext::Joint(std::string_view owner, std::string_view field,
                               const std::string& name) {
  // The rig's own name wins over aliases, so that a stream with the rig's joints never depends on a
  // skeleton map.
  int joint = skeleton_.Find(name);
  for (const auto& [own, theirs] : options_.aliases) {
    if (joint == kNoJoint && own == name) joint = skeleton_.Find(theirs);
  }
  if (joint != kNoJoint) return joint;
  if (!options_.allow_missing) {
    return Status(StatusCode::kNotFound, std::string(owner) + ": " + std::string(field) +
                                             " names joint '" + name +
                                             "', which the skeleton does not have");
  }
  AddOnce(name, &missing_joints_);
  return kNoJoint;
}

Result<std::vector<int>> BindContext::JointChain(std::string_view owner, std::string_view field,
                                                 const std::string& name) {
  std::vector<int> joints;
  for (const RoleChain& chain : options_.role_chains) {
    if (chain.joint != name) continue;
    for (const std::string& theirs : chain.skeleton_joints) {
      if (const int joint = skeleton_.Find(theirs); joint != kNoJoint) joints.push_back(joint);
    }
  }
  if (!joints.empty()) return joints;
  const Result<int> joint = Joint(owner, field, name);
  FURROW_RETURN_IF_ERROR(joint);
  if (*joint != kNoJoint) joints.push_back(*joint);
  return joints;
}

Result<int> BindContext::BlendShape(std::string_view owner, const std::string& name) {
  const std::span<const std::string> names = source_.blend_shape_names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (EqualsIgnoreCase(names[i], name)) return static_cast<int>(i);
  }
  // A rig that also reads joints accepts a stream of joints alone.
  if (!options_.allow_missing && !(names.empty() && source_.reads_joints)) {
    return Status(StatusCode::kNotFound,
                  std::string(owner) + ": blend shape '" + name + "' is not among the stream's");
  }
  AddOnce(name, &missing_blend_shapes_);
  return -1;
}

Status BindContext::Unusable(std::string_view owner, std::string_view why) {
  std::string what = std::string(owner) + ": " + std::string(why);
  // A daemon binds whatever stream arrives and goes on without the driver. Checks of a rig fail
  // instead.
  if (!options_.allow_missing) return {StatusCode::kInvalidArgument, std::move(what)};
  Warn(std::move(what) + "; it rests at 0");
  return {};
}

const std::vector<PreciseTransform>* BindContext::ReferenceLocals(std::string_view name) const {
  for (std::size_t i = 0; i < source_.reference_poses.size(); ++i) {
    if (source_.reference_poses[i].name == name) return &reference_locals_[i];
  }
  return nullptr;
}

float BindContext::ReferenceShape(std::string_view name, std::string_view blend_shape) const {
  for (const ReferencePose& pose : source_.reference_poses) {
    if (pose.name == name) return ShapeValueOf(pose, blend_shape);
  }
  return 0.0f;
}

}  // namespace furrow::wrinkle
