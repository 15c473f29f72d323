// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

class FieldCheck;
class FullPoseBuilder;

inline constexpr int kMaxControlPoints = 256;  // of one driver
inline constexpr int kMaxPoseValues = 64;      // of one driver; with nnls at most kMaxNnlsValues

// The point on a joint that a pose driver measures (4.1's B), or the coefficient of a blend shape.
struct ControlPoint {
  enum class Kind { kTail, kOrigin, kOffset, kBlendShape };
  std::string joint;  // empty for kBlendShape
  Kind kind = Kind::kTail;
  glm::vec3 offset{0.0f};    // for kOffset: in the joint's space, in units of `offset_size`
  float offset_size = 0.0f;  // SkeletonSize() the offset was measured on; 0: bound skeleton's units
  std::string blend_shape;   // for kBlendShape; matched without case

  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Optional("joint", &ControlPoint::joint);
    fields.Choice("kind", &ControlPoint::kind, {"tail", "origin", "offset", "blend_shape"});
    fields.Optional("blend_shape", &ControlPoint::blend_shape);
    fields.Optional("offset", &ControlPoint::offset);
    fields.Optional("offset_size", &ControlPoint::offset_size);
  }
};

enum class PoseSolve { kProjection, kNnls };

// One or several control points measured against named reference poses (4.1). The points are
// stacked into one long vector, so that a group of joints is fitted at once. Blend shapes are
// further components of the vector (pose_driver.h).
struct PoseDriver {
  static constexpr bool kMeasuresFromAnchor = true;
  static constexpr bool kAddsJoints = false;

  // A driver value and the reference pose at which it is 1.
  struct Value {
    std::string name;
    std::string reference_pose;

    template <class Fields>
    static void ListFields(Fields& fields) {
      fields.Required("name", &Value::name);
      fields.Required("reference_pose", &Value::reference_pose);
    }
  };
  std::vector<ControlPoint> points;
  std::vector<Value> values;
  std::string anchor;  // optional: the joint whose space the points are measured in; empty: the
                       // rig's anchor
  PoseSolve solve = PoseSolve::kProjection;
  float falloff = 0.0f;  // s of exp(-|perp|^2 / (2 s^2 |d|^2)), [0, 1000]; 0: no falloff

  // The fields as pose.fbs names them, in the order in which they are written.
  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("points", &PoseDriver::points);
    fields.Required("values", &PoseDriver::values);
    fields.Optional("anchor", &PoseDriver::anchor);
    fields.Choice("solve", &PoseDriver::solve, {"projection", "nnls"});
    fields.Optional("falloff", &PoseDriver::falloff);
  }
};

// The names in `values`.
[[nodiscard]] std::vector<std::string> DriverValueNames(const PoseDriver& driver);
void CheckFields(const PoseDriver& driver, const std::string& at, FieldCheck* check);
// Empty if all points are blend shapes. Otherwise the anchor, which may be "", comes last.
[[nodiscard]] std::vector<std::string> JointsRead(const PoseDriver& driver);
[[nodiscard]] std::vector<std::string> BlendShapesRead(const PoseDriver& driver);
[[nodiscard]] std::vector<std::string> JointsInfluenced(const PoseDriver& driver);
// The rig's reference pose, under its own name.
[[nodiscard]] Result<ReferencePose> FullPose(const PoseDriver& driver,
                                             const FullPoseBuilder& builder);

}  // namespace furrow::wrinkle
