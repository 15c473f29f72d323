// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "wrinkle/skeleton/size_reference.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/skeleton/transform.h"

namespace furrow::wrinkle {

// A joint's departure from its rest pose, in model axes. Model axes let a reference pose made on
// one skeleton apply to another skeleton with different local frames.
//
// With rest-pose model rotation G of the joint and G_p of its parent (identity for a root):
//   local rotation    = rest.rotation * inverse(G) * rotation * G
//   local translation = rest.translation + inverse(G_p) * moved
//   moved             = translation * bound_size / source_size + unscaled_translation
// On a skeleton with identity rest rotations (BVH), `rotation` is the local rotation itself.
struct JointDelta {
  std::string joint;
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 translation{0.0f};  // in units of the source skeleton; see ReferencePose::source_size
  // In units of the bound skeleton. Only in mixes of poses with and without a source_size.
  glm::vec3 unscaled_translation{0.0f};
};

// The coefficient of a tracker's blend shape in a reference pose.
struct ShapeValue {
  std::string blend_shape;  // matched without case
  float value = 1.0f;       // [-1000, 1000]; 0 is the rest

  friend bool operator==(const ShapeValue&, const ShapeValue&) = default;
};

// A pose of joints, of blend shapes, or of both.
struct ReferencePose {
  std::string name;
  std::vector<JointDelta> joints;  // all other joints stay at rest
  float source_size = 0.0f;  // SkeletonSize() of the source; 0: same units as the bound skeleton
  // How to measure the bound skeleton, if the rig says so (Rig::size_reference). May be null.
  std::shared_ptr<const SizeReference> size_reference = nullptr;
  std::vector<ShapeValue> shapes = {};  // all other blend shapes are 0
};

// The coefficient of a blend shape in a pose; 0 if the pose does not list it.
[[nodiscard]] float ShapeValueOf(const ReferencePose& pose, std::string_view blend_shape);

// True if the delta leaves its joint at rest. Pose files often list every joint.
[[nodiscard]] bool IsRest(const JointDelta& delta);

// Adds a joint's departure from rest to `local`, its local transform (formula: JointDelta).
// `scale` converts the delta's units to the skeleton's.
void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     Transform* local);
// The same in double precision. Two poses that are equal, or opposite, up to the rounding of their
// numbers then differ by 1e-7 of their size, and not by the rounding of joints far away.
void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     PreciseTransform* local);

// SkeletonSizeBy(pose.size_reference, skeleton) / pose.source_size; 1 if the pose states no size.
[[nodiscard]] float ReferencePoseScale(const ReferencePose& pose, const Skeleton& skeleton);

// Adds the joints of a reference pose to `locals`, which holds num_joints local transforms: the
// rest pose or any other pose. Error: kNotFound if the skeleton lacks a joint that moves; `locals`
// is then unchanged.
[[nodiscard]] Status ApplyReferencePose(const ReferencePose& pose, const Skeleton& skeleton,
                                        std::span<Transform> locals);

}  // namespace furrow::wrinkle
