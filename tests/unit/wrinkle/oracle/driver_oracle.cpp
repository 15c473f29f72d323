// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/driver_oracle.h"

#include <array>

#include "base/scalar.h"
#include "tests/unit/wrinkle/oracle/ball.h"
#include "tests/unit/wrinkle/oracle/blend_shape.h"
#include "tests/unit/wrinkle/oracle/hinge.h"
#include "tests/unit/wrinkle/oracle/pose_projection.h"
#include "wrinkle/skeleton/twist.h"
#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {
namespace {

const glm::vec3 kNone(0.0f);

class DriverOracle {
 public:
  DriverOracle(const BindingData& data, const LocalPose& pose)
      : data_(data), pose_(pose), values_(data.driver_value_names.size(), 0.0f) {}

  void Evaluate(const PoseDriverSet& drivers) {
    for (int i = 0; i < static_cast<int>(drivers.entries().size()); ++i) {
      const PoseDriverSet::Entry& entry = drivers.entries()[i];
      std::vector<glm::vec3> moved;
      for (const MeasuredPoint& point : drivers.points(entry)) {
        moved.push_back(data_.chains.Evaluate(pose_.joints, point.point) - point.rest);
      }
      for (const MeasuredShapes& shapes : drivers.shapes(entry)) {
        const auto& [a, b, c] = shapes.blend_shapes;
        moved.push_back(shapes.unit * glm::vec3(Coefficient(a), Coefficient(b), Coefficient(c)));
      }
      std::vector<float> along(static_cast<std::size_t>(entry.num_values));
      const bool is_nnls = entry.solve == PoseSolve::kNnls;
      if (is_nnls) drivers.SolveNnls(i, moved, along);
      for (int k = 0; k < entry.num_values; ++k) {
        const StackedPoints d = drivers.Displacement(entry, k);
        const float square = drivers.SquaredDisplacement(entry, k);
        if (!is_nnls) along[k] = Along(moved, d, square);
        const float off = is_nnls ? drivers.SquaredResidual(i, moved, along)
                                  : SquaredDistance(moved, d, along[k]);
        const float falloff = entry.falloff > 0.0f ? Falloff(off, square, entry.falloff) : 1.0f;
        values_[entry.first_value + k] =
            square > 0.0f ? Saturate(Saturate(along[k]) * falloff) : 0.0f;
      }
    }
  }

  void Evaluate(const HingeDriverSet& drivers) {
    for (const HingeDriverSet::Entry& entry : drivers.entries()) {
      const glm::vec3 straight =
          entry.straight == kNone ? entry.bones.Upper(pose_.joints, data_.chains) : entry.straight;
      const glm::vec3 lower = entry.bones.Lower(pose_.joints, data_.chains);
      float flexed = 0.0f;
      if (straight != kNone && lower != kNone) {
        flexed = entry.axis == kNone ? Bend(glm::dot(straight, lower), entry.bend_scale)
                                     : SignedBend(straight, lower, entry.axis, entry.bend_scale);
      }
      values_[entry.first_value] = flexed;
      values_[entry.first_value + 1] = 1.0f - flexed;
    }
  }

  void Evaluate(const BallDriverSet& drivers) {
    for (const BallDriverSet::Entry& entry : drivers.entries()) {
      const glm::vec3 straight =
          entry.straight == kNone ? entry.bones.Upper(pose_.joints, data_.chains) : entry.straight;
      const glm::vec3 lower = entry.bones.Lower(pose_.joints, data_.chains);
      BallShares shares;
      if (straight != kNone && lower != kNone) {
        const float cosine = glm::dot(straight, lower);
        const glm::vec3 across = lower - cosine * straight;
        shares = SplitWideBend(entry.mode, 1.0f, cosine, glm::dot(across, entry.forward),
                               glm::dot(across, entry.right), entry.rest_side);
        const auto bend = [&](std::size_t side) {
          return Saturate((entry.ranges[side].start - cosine) * entry.ranges[side].scale);
        };
        shares.front *= bend(0);
        shares.back *= bend(1);
        shares.left *= bend(2);
        shares.right *= bend(3);
      }
      float* const values = &values_[entry.first_value];
      values[0] = shares.front;
      values[1] = shares.back;
      values[2] = shares.left;
      values[3] = shares.right;
    }
  }

  void Evaluate(const TwistDriverSet& drivers) {
    for (const TwistDriverSet::Entry& entry : drivers.entries()) {
      float angle = 0.0f;
      for (const TwistDriverSet::TwistJoint& joint : drivers.joints(entry)) {
        angle += TwistAngle(joint.rest_inverse * pose_.joints[joint.joint].rotation, joint.axis);
      }
      values_[entry.first_value] = Saturate(angle * entry.inverse_full);
      values_[entry.first_value + 1] = Saturate(-angle * entry.inverse_full);
    }
  }

  void Evaluate(const BlendShapeDriverSet& drivers) {
    for (const BlendShapeDriverSet::Entry& entry : drivers.entries()) {
      values_[entry.first_value] =
          BlendShapeValue(Coefficient(entry.blend_shape), entry.neutral, entry.full);
    }
  }

  // strain_test.cpp holds the strain of a patch to worked values; the lanes only bring its frames.
  void Evaluate(const StrainDriverSet& drivers) {
    for (int i = 0; i < drivers.num_entries(); ++i) {
      const auto frames = drivers.Frames(i, pose_.joints, data_.chains);
      drivers.EvaluateFrames(i, frames, pose_.blend_shapes,
                             std::span(values_).subspan(drivers.first_value(i), 4));
    }
  }

  std::vector<float> Take(std::size_t num_values) && {
    std::fill(values_.begin() + static_cast<std::ptrdiff_t>(num_values), values_.end(), 0.0f);
    return std::move(values_);
  }

 private:
  static float Along(StackedPoints moved, StackedPoints d, float square) {
    std::vector<glm::vec3> projection;
    for (const glm::vec3& point : d) projection.push_back(Projection(point, square));
    return ProjectionAlong(moved, projection);
  }

  // 0 for a blend shape that a driver or the pose lacks.
  float Coefficient(int shape) const {
    const auto& shapes = pose_.blend_shapes;
    return shape >= 0 && shape < static_cast<int>(shapes.size()) ? shapes[shape] : 0.0f;
  }

  const BindingData& data_;
  const LocalPose& pose_;
  std::vector<float> values_;
};

}  // namespace

std::vector<float> EvaluateDriversPlainly(const RigBinding& binding, const LocalPose& pose,
                                          std::size_t num_drivers) {
  const BindingData& data = binding.data();
  DriverOracle oracle(data, pose);
  VisitDriverSets(data.drivers, [&](const auto& drivers) { oracle.Evaluate(drivers); });
  return std::move(oracle).Take(data.NumValues(num_drivers));
}

}  // namespace furrow::wrinkle
