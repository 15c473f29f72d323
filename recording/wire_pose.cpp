// SPDX-License-Identifier: Apache-2.0
#include "recording/wire_pose.h"

#include <numeric>
#include <optional>
#include <span>

namespace furrow::recording {
namespace {

protocol::Vec3 Wire(const glm::vec3& v) { return {v.x, v.y, v.z}; }
protocol::Quat Wire(const glm::quat& q) { return {q.x, q.y, q.z, q.w}; }

}  // namespace

protocol::SkeletonOffer OfferOf(const motion::Clip& clip, const std::string& subject,
                                float metres_per_unit) {
  protocol::SkeletonOffer offer;
  offer.subject = subject;
  offer.metres_per_unit = metres_per_unit;
  offer.blend_shape_names = clip.blend_shape_names;
  const wrinkle::Skeleton& skeleton = clip.skeleton;
  offer.joints.resize(static_cast<std::size_t>(skeleton.num_joints()));
  for (std::size_t j = 0; j < offer.joints.size(); ++j) {
    const wrinkle::Transform& rest = skeleton.rest_pose()[j];
    offer.joints[j] = {.name = skeleton.joint_names()[j],
                       .parent = skeleton.joint_parents()[j],
                       .rest_translation = Wire(rest.translation),
                       .rest_rotation = Wire(rest.rotation),
                       .rest_scale = Wire(rest.scale),
                       .has_tail = true,
                       .tail = Wire(skeleton.tails()[j])};
  }
  return offer;
}

void FillPose(const motion::Clip& clip, int frame, protocol::PoseFrame* pose) {
  const auto rest = clip.skeleton.rest_pose();
  const auto locals =
      std::span(clip.locals).subspan(rest.size() * static_cast<std::size_t>(frame), rest.size());
  pose->partial = false;
  pose->timecode =
      clip.timecodes.empty() ? std::nullopt : clip.timecodes[static_cast<std::size_t>(frame)];
  pose->num_joints = static_cast<std::uint16_t>(rest.size());
  // All rotations are sent, but translations and scales only where they leave rest. Receivers of
  // whole poses put the others at rest.
  pose->rotation_joints.resize(rest.size());
  std::iota(pose->rotation_joints.begin(), pose->rotation_joints.end(), std::uint16_t{0});
  pose->rotations.clear();
  pose->translation_joints.clear();
  pose->translations.clear();
  pose->scale_joints.clear();
  pose->scales.clear();
  for (std::size_t j = 0; j < rest.size(); ++j) {
    pose->rotations.push_back(Wire(locals[j].rotation));
    const auto joint = static_cast<std::uint16_t>(j);
    if (locals[j].translation != rest[j].translation) {
      pose->translation_joints.push_back(joint);
      pose->translations.push_back(Wire(locals[j].translation - rest[j].translation));
    }
    if (locals[j].scale != rest[j].scale) {
      pose->scale_joints.push_back(joint);
      pose->scales.push_back(Wire(locals[j].scale));
    }
  }
  const std::size_t shapes = clip.blend_shape_names.size();
  pose->num_blend_shapes = static_cast<std::uint16_t>(shapes);
  pose->blend_shape_indices.resize(shapes);
  std::iota(pose->blend_shape_indices.begin(), pose->blend_shape_indices.end(), std::uint16_t{0});
  const auto values =
      std::span(clip.blend_shapes).subspan(shapes * static_cast<std::size_t>(frame), shapes);
  pose->blend_shapes.assign(values.begin(), values.end());
}

}  // namespace furrow::recording
