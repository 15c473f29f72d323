// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/blend_shape/blend_shape_fields.h"

#include <cmath>

#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/fields/field_check.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const BlendShapeDriver&) { return {"value"}; }

void CheckFields(const BlendShapeDriver& driver, const std::string& at, FieldCheck* check) {
  check->Label(at, ".blend_shape", driver.blend_shape);
  check->Range(at, ".neutral", driver.neutral, -kMaxCoefficient, kMaxCoefficient);
  check->Range(at, ".full", driver.full, -kMaxCoefficient, kMaxCoefficient);
  // The kernel divides by the difference.
  check->Require(std::abs(driver.full - driver.neutral) >= 1e-4f, at, ".full",
                 "full and neutral are the same coefficient");
}

std::vector<std::string> JointsRead(const BlendShapeDriver&) { return {}; }

std::vector<std::string> BlendShapesRead(const BlendShapeDriver& driver) {
  return {driver.blend_shape};
}

std::vector<std::string> JointsInfluenced(const BlendShapeDriver&) { return {}; }

Result<ReferencePose> FullPose(const BlendShapeDriver&, const FullPoseBuilder& builder) {
  return builder.Unsupported();
}

}  // namespace furrow::wrinkle
