// SPDX-License-Identifier: Apache-2.0
#include "client/c/pose_feed.h"

#include <algorithm>

#include "client/c/reordering.h"

namespace furrow::capi {
namespace {

void Put(const protocol::Vec3& from, std::size_t index, float* to) {
  if (to == nullptr) return;
  to[3 * index] = from.x;
  to[3 * index + 1] = from.y;
  to[3 * index + 2] = from.z;
}

void Put(const protocol::Quat& from, std::size_t index, float* to) {
  if (to == nullptr) return;
  to[4 * index] = from.x;
  to[4 * index + 1] = from.y;
  to[4 * index + 2] = from.z;
  to[4 * index + 3] = from.w;
}

}  // namespace

void PoseFeed::SetSubscription(std::uint16_t subscription) {
  subscription_ = subscription;
  error_ = FURROW_OK;
  retry_.Clear();
}

void PoseFeed::OnError(furrow_status status, std::int64_t retry_us) {
  error_ = status;
  retry_.SetDue(retry_us);
  subscription_ = 0;
}

void PoseFeed::OnSkeleton(const protocol::SkeletonOffer& skeleton) {
  error_ = FURROW_OK;
  has_pose_ = has_pose_ && skeleton.skeleton_hash == skeleton_.skeleton_hash;
  skeleton_ = skeleton;
}

bool PoseFeed::OnPose(const protocol::Header& header, const protocol::PoseFrame& pose,
                      std::int64_t now_us) {
  const auto& joints = skeleton_.joints;
  if (skeleton_status() != FURROW_OK || pose.skeleton_hash != skeleton_.skeleton_hash ||
      pose.num_joints != joints.size() ||
      pose.num_blend_shapes != skeleton_.blend_shape_names.size()) {
    return false;
  }
  if (has_pose_ && IsLate(header, header_, now_us - received_us_)) return false;
  // Joints that are not listed are at rest. The decoder has checked that indices and counts fit.
  rotations_.resize(joints.size());
  translations_.resize(joints.size());
  scales_.resize(joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    rotations_[i] = joints[i].rest_rotation;
    translations_[i] = joints[i].rest_translation;
    scales_[i] = joints[i].rest_scale;
  }
  blend_shapes_.assign(skeleton_.blend_shape_names.size(), 0.0f);
  for (std::size_t i = 0; i < pose.rotations.size(); ++i) {
    rotations_[pose.rotation_joints[i]] = pose.rotations[i];
  }
  for (std::size_t i = 0; i < pose.translations.size(); ++i) {
    // The wire carries offsets from the rest pose.
    protocol::Vec3& translation = translations_[pose.translation_joints[i]];
    translation.x += pose.translations[i].x;
    translation.y += pose.translations[i].y;
    translation.z += pose.translations[i].z;
  }
  for (std::size_t i = 0; i < pose.scales.size(); ++i) {
    scales_[pose.scale_joints[i]] = pose.scales[i];
  }
  for (std::size_t i = 0; i < pose.blend_shapes.size(); ++i) {
    blend_shapes_[pose.blend_shape_indices[i]] = pose.blend_shapes[i];
  }
  header_ = header;
  received_us_ = now_us;
  has_pose_ = true;
  ++number_;
  return true;
}

furrow_skeleton_info PoseFeed::Info() const {
  furrow_skeleton_info info{};
  info.num_joints = static_cast<std::uint32_t>(skeleton_.joints.size());
  info.num_blend_shapes = static_cast<std::uint32_t>(skeleton_.blend_shape_names.size());
  info.metres_per_unit = skeleton_.metres_per_unit;
  info.layout = skeleton_.skeleton_hash;
  return info;
}

furrow_joint PoseFeed::Joint(std::uint32_t index) const {
  const protocol::OfferedJoint& from = skeleton_.joints[index];
  furrow_joint joint{};
  joint.parent = from.parent;
  Put(from.rest_translation, 0, joint.translation);
  Put(from.rest_rotation, 0, joint.rotation);
  Put(from.rest_scale, 0, joint.scale);
  return joint;
}

furrow_status PoseFeed::skeleton_status() const {
  if (error_ != FURROW_OK) return error_;
  const bool empty = skeleton_.joints.empty() && skeleton_.blend_shape_names.empty();
  return empty ? FURROW_NO_DATA : FURROW_OK;
}

furrow_status PoseFeed::status() const {
  const furrow_status status = skeleton_status();
  return status != FURROW_OK || has_pose_ ? status : FURROW_NO_DATA;
}

furrow_status PoseFeed::Copy(std::int64_t now_us, furrow_pose_buffer* to) const {
  const std::uint32_t joint_room = to->num_joints;
  const std::uint32_t shape_room = to->num_blend_shapes;
  to->num_joints = static_cast<std::uint32_t>(rotations_.size());
  to->num_blend_shapes = static_cast<std::uint32_t>(blend_shapes_.size());
  to->sequence = header_.sequence;
  to->layout = skeleton_.skeleton_hash;
  to->number = number_;
  to->capture_time_us = header_.capture_time_us;
  to->age_us = std::max<std::int64_t>(0, now_us - received_us_);
  const bool joints = to->rotations || to->translations || to->scales;
  if ((joints && joint_room < to->num_joints) ||
      (to->blend_shapes && shape_room < to->num_blend_shapes)) {
    return FURROW_BUFFER_TOO_SMALL;
  }
  for (std::size_t i = 0; i < rotations_.size(); ++i) {
    Put(rotations_[i], i, to->rotations);
    Put(translations_[i], i, to->translations);
    Put(scales_[i], i, to->scales);
  }
  if (to->blend_shapes != nullptr) std::ranges::copy(blend_shapes_, to->blend_shapes);
  return FURROW_OK;
}

}  // namespace furrow::capi
