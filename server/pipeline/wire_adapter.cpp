// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/wire_adapter.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "recording/wire_joints.h"

namespace furrow::server {
namespace {

// Indices come from the network and address arrays.
bool IndicesFit(std::span<const std::uint16_t> indices, std::size_t count) {
  return std::ranges::all_of(indices, [count](std::uint16_t index) { return index < count; });
}

protocol::Vec3 ToWire(const glm::vec3& v) { return {v.x, v.y, v.z}; }
protocol::Quat ToWire(const glm::quat& q) { return {q.x, q.y, q.z, q.w}; }

// 0, 1, 2 ...
void ListAll(std::size_t count, std::vector<std::uint16_t>* indices) {
  indices->resize(count);
  std::iota(indices->begin(), indices->end(), std::uint16_t{0});
}

}  // namespace

StreamOffer ToStreamOffer(const protocol::SkeletonOffer& offer) {
  return {.joints = recording::JointsOf(offer), .blend_shapes = offer.blend_shape_names};
}

bool PoseFits(const protocol::PoseFrame& frame, const StreamDefinition& stream) {
  const std::size_t joints = stream.joint_of_wire.size();
  const std::size_t shapes = stream.blend_shapes.size();
  return frame.num_joints == joints && frame.num_blend_shapes == shapes &&
         IndicesFit(frame.rotation_joints, joints) &&
         IndicesFit(frame.translation_joints, joints) && IndicesFit(frame.scale_joints, joints) &&
         IndicesFit(frame.blend_shape_indices, shapes) && frame.rotations.size() <= joints &&
         frame.translations.size() <= joints && frame.scales.size() <= joints &&
         frame.blend_shapes.size() <= shapes;
}

void ApplyPose(const protocol::PoseFrame& frame, const StreamDefinition& stream,
               wrinkle::LocalPose* pose) {
  recording::ApplyWirePose(
      frame, {.rest = stream.skeleton.rest_pose(), .joint_of_wire = stream.joint_of_wire},
      pose->joints, pose->blend_shapes);
}

void ToWholePose(const wrinkle::LocalPose& pose, const StreamDefinition& stream,
                 protocol::PoseFrame* frame) {
  const std::span<const wrinkle::Transform> rest = stream.skeleton.rest_pose();
  const std::size_t joints = stream.joint_of_wire.size();
  frame->partial = false;
  frame->num_joints = static_cast<std::uint16_t>(joints);
  frame->num_blend_shapes = static_cast<std::uint16_t>(stream.blend_shapes.size());
  ListAll(joints, &frame->rotation_joints);
  frame->rotations.resize(joints);
  frame->translation_joints.clear();
  frame->translations.clear();
  frame->scale_joints.clear();
  frame->scales.clear();
  for (std::size_t i = 0; i < joints; ++i) {
    const auto joint = static_cast<std::size_t>(stream.joint_of_wire[i]);
    const wrinkle::Transform& local = pose.joints[joint];
    frame->rotations[i] = ToWire(local.rotation);
    // Exact comparison: a value that came from rest is bit by bit the same.
    if (local.translation != rest[joint].translation) {
      frame->translation_joints.push_back(static_cast<std::uint16_t>(i));
      frame->translations.push_back(ToWire(local.translation - rest[joint].translation));
    }
    if (local.scale != rest[joint].scale) {
      frame->scale_joints.push_back(static_cast<std::uint16_t>(i));
      frame->scales.push_back(ToWire(local.scale));
    }
  }
  // Without those that the daemon has computed for its rig.
  const auto sent = std::span(pose.blend_shapes).first(stream.blend_shapes.size());
  ListAll(sent.size(), &frame->blend_shape_indices);
  frame->blend_shapes.assign(sent.begin(), sent.end());
}

}  // namespace furrow::server
