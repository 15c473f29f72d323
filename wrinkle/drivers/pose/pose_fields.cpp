// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/pose_fields.h"

#include <string_view>
#include <unordered_set>

#include "base/ascii.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/drivers/pose/nnls.h"
#include "wrinkle/fields/field_check.h"
#include "wrinkle/fields/rig_field.h"

namespace furrow::wrinkle {
namespace {

// `seen`: lowercase names of the blend shapes before this point.
void CheckPoint(const ControlPoint& point, const std::string& at,
                std::unordered_set<std::string>* seen, FieldCheck* check) {
  if (point.kind == ControlPoint::Kind::kBlendShape) {
    check->Label(at, ".blend_shape", point.blend_shape);
    check->Require(point.joint.empty(), at, ".joint", "a blend shape has no joint", "remove it");
    check->Require(seen->insert(AsciiLower(point.blend_shape)).second, at, ".blend_shape",
                   "the blend shape occurs twice");
  } else {
    check->Label(at, ".joint", point.joint);
    check->Require(point.blend_shape.empty(), at, ".blend_shape",
                   "a point on a joint has no blend shape", "set kind to \"blend_shape\"");
  }
  check->Finite(at, ".offset", point.offset);
  check->Range(at, ".offset_size", point.offset_size, 0.0f, kMaxSkeletonSize);
}

}  // namespace

std::vector<std::string> DriverValueNames(const PoseDriver& driver) {
  std::vector<std::string> names;
  for (const PoseDriver::Value& value : driver.values) names.push_back(value.name);
  return names;
}

void CheckFields(const PoseDriver& driver, const std::string& at, FieldCheck* check) {
  if (!driver.anchor.empty()) check->Label(at, ".anchor", driver.anchor);
  const bool nnls = driver.solve == PoseSolve::kNnls;
  check->Require(!driver.points.empty(), at, ".points", "a pose driver needs a control point");
  check->Require(!driver.values.empty(), at, ".values", "a pose driver needs a value");
  check->Count(at, ".points", driver.points.size(), kMaxControlPoints);
  // nnls works on fixed arrays and its cost grows with the cube of the number of values, hence its
  // lower limit.
  check->Count(at, ".values", driver.values.size(), nnls ? kMaxNnlsValues : kMaxPoseValues);
  check->Range(at, ".falloff", driver.falloff, 0.0f, 1000.0f);
  std::unordered_set<std::string> shapes;
  for (std::size_t i = 0; i < driver.points.size(); ++i) {
    CheckPoint(driver.points[i], FieldAt(at + ".points", i), &shapes, check);
  }
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < driver.values.size(); ++i) {
    const std::string value = FieldAt(at + ".values", i);
    check->Name(value, ".name", driver.values[i].name);
    check->Once(value, ".name", driver.values[i].name, &names);
  }
}

std::vector<std::string> JointsRead(const PoseDriver& driver) {
  std::vector<std::string> joints = JointsInfluenced(driver);
  if (!joints.empty()) joints.push_back(driver.anchor);
  return joints;
}

// The anchor is only the space of the measurement.
std::vector<std::string> JointsInfluenced(const PoseDriver& driver) {
  std::vector<std::string> joints;
  for (const ControlPoint& point : driver.points) {
    if (point.kind != ControlPoint::Kind::kBlendShape) joints.push_back(point.joint);
  }
  return joints;
}

std::vector<std::string> BlendShapesRead(const PoseDriver& driver) {
  std::vector<std::string> names;
  for (const ControlPoint& point : driver.points) {
    if (point.kind == ControlPoint::Kind::kBlendShape) names.push_back(point.blend_shape);
  }
  return names;
}

Result<ReferencePose> FullPose(const PoseDriver& driver, const FullPoseBuilder& builder) {
  for (const PoseDriver::Value& value : driver.values) {
    if (value.name == builder.value()) return builder.FromRig(value.reference_pose);
  }
  return Status(StatusCode::kInternal, "the driver has no such value");
}

}  // namespace furrow::wrinkle
