// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/full_pose.h"

#include <algorithm>
#include <string>
#include <vector>

#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

Result<ReferencePose> FullPose(const Rig& rig, const Driver& driver, std::string_view value,
                               const Skeleton& skeleton, std::optional<float> degrees) {
  const std::vector<std::string> values = DriverValueNames(driver);
  if (std::find(values.begin(), values.end(), value) == values.end()) {
    return Status(StatusCode::kNotFound,
                  "driver '" + driver.name + "' has no value '" + std::string(value) + "'");
  }
  const FullPoseBuilder builder(driver.name, value, skeleton, rig.reference_poses, degrees);
  return VisitFields(driver, [&](const auto& fields) { return FullPose(fields, builder); });
}

}  // namespace furrow::wrinkle
