// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

class FieldCheck;
class FullPoseBuilder;

// A tracker's coefficient c: value "value", clamp((c - neutral) / (full - neutral), 0, 1).
struct BlendShapeDriver {
  static constexpr bool kMeasuresFromAnchor = false;
  static constexpr bool kAddsJoints = false;

  std::string blend_shape;  // matched without case
  float neutral = 0.0f;     // the coefficient that gives 0, [-1000, 1000]
  float full = 1.0f;        // the coefficient that gives 1; may be below `neutral`, but not equal

  // The fields as blend_shape.fbs names them, in the order in which they are written.
  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("blend_shape", &BlendShapeDriver::blend_shape);
    fields.Optional("neutral", &BlendShapeDriver::neutral);
    fields.Optional("full", &BlendShapeDriver::full);
  }
};

[[nodiscard]] std::vector<std::string> DriverValueNames(const BlendShapeDriver& driver);
void CheckFields(const BlendShapeDriver& driver, const std::string& at, FieldCheck* check);
[[nodiscard]] std::vector<std::string> JointsRead(const BlendShapeDriver& driver);
[[nodiscard]] std::vector<std::string> BlendShapesRead(const BlendShapeDriver& driver);
[[nodiscard]] std::vector<std::string> JointsInfluenced(const BlendShapeDriver& driver);
// Always kUnsupported.
[[nodiscard]] Result<ReferencePose> FullPose(const BlendShapeDriver& driver,
                                             const FullPoseBuilder& builder);

}  // namespace furrow::wrinkle
