// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "motion/clip/clip.h"

namespace furrow::motion {

// Replaces the rest pose of a clip's skeleton. `rest`: one local transform per joint. The motion
// stays.
//
// Errors: kNonFinite and kInvalidArgument, as Skeleton::Create().
[[nodiscard]] Status SetRestPose(std::span<const wrinkle::Transform> rest, Clip* clip);

}  // namespace furrow::motion
