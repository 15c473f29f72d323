// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/neutral_frame.h"

#include <algorithm>

#include "protocol/messages/hash.h"

namespace furrow::protocol::mocap {

SkeletonOffer MakeOffer(const NeutralFrame& frame) {
  SkeletonOffer offer;
  offer.subject = frame.subject;
  for (const NeutralJoint& joint : frame.joints) {
    OfferedJoint offered;
    offered.name = joint.name;
    offered.parent = static_cast<std::int16_t>(joint.parent);
    offered.rest_translation = joint.rest_translation;
    offer.joints.push_back(std::move(offered));
  }
  for (const NeutralBlendShape& shape : frame.blend_shapes) {
    offer.blend_shape_names.push_back(shape.name);
  }
  offer.skeleton_hash = SkeletonHash(offer);
  return offer;
}

void MakePose(const NeutralFrame& frame, const SkeletonOffer& offer, PoseFrame& pose) {
  const std::size_t joints = std::min(frame.joints.size(), offer.joints.size());
  const std::size_t shapes = std::min(frame.blend_shapes.size(), offer.blend_shape_names.size());
  pose.skeleton_hash = offer.skeleton_hash;
  pose.partial = false;
  pose.timecode = frame.timecode;
  pose.num_joints = static_cast<std::uint16_t>(offer.joints.size());
  pose.num_blend_shapes = static_cast<std::uint16_t>(offer.blend_shape_names.size());
  pose.scale_joints.clear();
  pose.scales.clear();
  pose.rotation_joints.resize(joints);
  pose.translation_joints.resize(joints);
  pose.rotations.resize(joints);
  pose.translations.resize(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    const Vec3& rest = offer.joints[i].rest_translation;
    const Vec3& now = frame.joints[i].translation;
    pose.rotation_joints[i] = pose.translation_joints[i] = static_cast<std::uint16_t>(i);
    pose.rotations[i] = frame.joints[i].rotation;
    // The wire carries translations as offsets from rest.
    pose.translations[i] = {now.x - rest.x, now.y - rest.y, now.z - rest.z};
  }
  pose.blend_shape_indices.resize(shapes);
  pose.blend_shapes.resize(shapes);
  for (std::size_t i = 0; i < shapes; ++i) {
    pose.blend_shape_indices[i] = static_cast<std::uint16_t>(i);
    pose.blend_shapes[i] = frame.blend_shapes[i].value;
  }
}

}  // namespace furrow::protocol::mocap
