// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/protocol/samples.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "protocol/messages/hash.h"

namespace furrow::protocol::test {

SkeletonOffer MakeOffer(int num_joints, int num_blend_shapes) {
  SkeletonOffer offer;
  offer.subject = "anna";
  offer.joints.resize(static_cast<std::size_t>(num_joints));
  for (int i = 0; i < num_joints; ++i) {
    OfferedJoint& joint = offer.joints[static_cast<std::size_t>(i)];
    joint.name = "joint_" + std::to_string(i);
    joint.parent = static_cast<std::int16_t>(i - 1);
    joint.rest_translation = {0.0f, 0.1f, 0.01f * static_cast<float>(i)};
    joint.has_tail = i % 3 == 2;
    if (joint.has_tail) joint.tail = {0.0f, 0.05f, 0.0f};
  }
  for (int i = 0; i < num_blend_shapes; ++i) {
    offer.blend_shape_names.push_back("shape_" + std::to_string(i));
  }
  offer.skeleton_hash = SkeletonHash(offer);
  return offer;
}

PoseFrame MakePose(int num_joints, int num_blend_shapes, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  PoseFrame pose;
  pose.skeleton_hash = 42;
  pose.num_joints = static_cast<std::uint16_t>(num_joints);
  pose.num_blend_shapes = static_cast<std::uint16_t>(num_blend_shapes);
  for (int i = 0; i < num_joints; ++i) {
    Quat q{normal(random), normal(random), normal(random), normal(random)};
    const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    pose.rotations.push_back({q.x / length, q.y / length, q.z / length, q.w / length});
    pose.translations.push_back({0.05f * unit(random), 0.05f * unit(random), 0.05f * unit(random)});
    pose.rotation_joints.push_back(static_cast<std::uint16_t>(i));
  }
  pose.translation_joints = pose.rotation_joints;
  for (int i = 0; i < num_blend_shapes; ++i) {
    pose.blend_shape_indices.push_back(static_cast<std::uint16_t>(i));
    pose.blend_shapes.push_back(0.5f + 0.5f * unit(random));
  }
  return pose;
}

SubjectState MakeState(int num_joints, int num_blend_shapes) {
  SubjectState state;
  state.subject = "anna";
  state.skeleton_hash = 42;
  state.publisher_session = 7;
  state.run = 8;
  state.has_pose = state.has_neutral = true;
  state.newest_sequence = 10;
  state.pose = MakePose(num_joints, num_blend_shapes, 1);
  state.neutral = MakePose(num_joints, num_blend_shapes, 2);
  state.values_hash = 9;
  state.num_drivers = 2;
  state.filtered = {0.25f, 0.5f};
  state.inputs = {0.3f, 0.75f};
  state.speeds = {0.5f, -2.5f};
  state.since_input_s = 0.125;
  state.captures = "{}";
  return state;
}

double AngleBetween(const Quat& a, const Quat& b) {
  const auto distance = [&a, &b](double sign) {
    return std::hypot(std::hypot(a.x - sign * b.x, a.y - sign * b.y),
                      std::hypot(a.z - sign * b.z, a.w - sign * b.w));
  };
  return 4.0 * std::asin(std::min(distance(1.0), distance(-1.0)) / 2.0);
}

}  // namespace furrow::protocol::test
