// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// The pose at which a driver's value is 1. Baking makes the value's folds from it.
//
// - A ball that is fully bent beyond 120 degrees may rest on another side than the value's. Its
//   value is then below 1 in every pose (docs/ALGORITHM.md), and the pose is the full bend all the
//   same.
// - FullPose() of drivers/<kind>/<kind>_fields.h states the pose of each kind. The rest of the body
//   rests.
// - The pose of a pose driver keeps the name of its reference pose, and its blend shapes. The other
//   poses are called "<driver>.<value>".
// - `degrees`: the pose at that angle of a hinge, a ball or a twist instead (DriverValueAtAngle()).
// - The pose may be the rest pose, for example for "extended" of a straight limb.
//
// Errors: kUnsupported for kinds that no pose of joints raises (blend shapes, strain); kNotFound
// for a missing joint, reference pose or value; kInvalidArgument for a driver that cannot work on
// the skeleton. All name the driver.
[[nodiscard]] Result<ReferencePose> FullPose(const Rig& rig, const Driver& driver,
                                             std::string_view value, const Skeleton& skeleton,
                                             std::optional<float> degrees = std::nullopt);

}  // namespace furrow::wrinkle
