// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// The pose at which a driver's value is 1: what the folds that it raises are made from.
//
// - A pose driver's is the rig's reference pose; its own name is kept, others are called
//   "<driver>.<value>".
// - A hinge's is full flexion about its axis, or ("extended") the limb made straight; without an
// axis
//   a limb bends on the way it is bent at rest. A ball's is the full bend towards that side, a
//   twist's the full angle shared out evenly over its joints. The rest of the body rests.
// - The pose may be the rest pose, where that is what the value means: a straight limb's
// "extended".
//
// Errors: kUnsupported for blend shapes and strain, which no pose of joints answers for; kNotFound
// (a joint, a reference pose or a value that is not there); kInvalidArgument for a driver that
// makes no sense on the skeleton. All name the driver.
[[nodiscard]] Result<ReferencePose> FullPose(const Rig& rig, const Driver& driver,
                                             std::string_view value, const Skeleton& skeleton);

}  // namespace furrow::wrinkle
