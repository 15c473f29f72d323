// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/skeleton/transform.h"

namespace furrow::wrinkle {

// True where a delta leaves its joint at rest: pose files list every joint.
[[nodiscard]] bool IsRest(const JointDelta& delta);

// Adds a joint's departure from rest to `local`, its local transform (see JointDelta for the
// formula). `scale`: from the delta's units to the skeleton's.
void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     Transform* local);

// SkeletonSize(skeleton) / pose.source_size; 1 where the pose states no size.
[[nodiscard]] float ReferencePoseScale(const ReferencePose& pose, const Skeleton& skeleton);

// Adds a reference pose to `locals`, num_joints local transforms (the rest pose, or another pose
// that is to be changed). Error: kNotFound where a joint that moves is not there; nothing is
// changed then.
[[nodiscard]] Status ApplyReferencePose(const ReferencePose& pose, const Skeleton& skeleton,
                                        std::span<Transform> locals);

}  // namespace furrow::wrinkle
