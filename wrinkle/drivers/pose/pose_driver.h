// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "wrinkle/drivers/common/bind_context.h"
#include "wrinkle/drivers/common/driver_explanation.h"
#include "wrinkle/drivers/pose/nnls.h"
#include "wrinkle/drivers/pose/pose_fields.h"
#include "wrinkle/drivers/pose/pose_plan.h"

namespace furrow::wrinkle {

// Control points stacked into one long vector: points of one driver, in one space and unit.
using StackedPoints = std::span<const glm::vec3>;

// All pose drivers of a binding: entries that index flat pools. Private to wrinkle/.
// pose_lanes-inl.h evaluates the drivers; this class solves nnls.
class PoseDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    int num_values = 0;
    std::uint32_t first_point = 0;  // into points_
    std::uint32_t num_points = 0;
    std::uint32_t first_displacement = 0;  // into displacements_: num_values x num_points
    std::uint32_t first_square = 0;        // into squares_: num_values
    std::uint32_t nnls = 0;                // into nnls_, for PoseSolve::kNnls
    std::uint32_t first_direction = 0;     // into directions_, for PoseSolve::kNnls
    PoseSolve solve = PoseSolve::kProjection;
    float falloff = 0.0f;
    bool in_model_space = false;  // no anchor: points are in the model space of poses
  };

  // Adds a driver with values that begin at `first_value` of the binding's driver values.
  [[nodiscard]] Status Bind(const std::string& name, const PoseDriver& driver, int first_value,
                            BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the geometry of each value.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  // The nnls weights of an entry's reference poses, not clamped. `moved` holds each control point's
  // departure from rest, in anchor space.
  void SolveNnls(int entry, StackedPoints moved, std::span<float> along) const;
  // The squared distance that an nnls fit leaves over: |moved - sum of along[k] d_k|^2, with d_k
  // the Displacement() of value k.
  [[nodiscard]] float SquaredResidual(int entry, StackedPoints moved,
                                      std::span<const float> along) const;

  [[nodiscard]] const PosePlan& plan() const { return plan_; }

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] std::span<const MeasuredPoint> points(const Entry& entry) const {
    return std::span(points_).subspan(entry.first_point, entry.num_points);
  }
  // The displacement d of value `value`: from rest to its reference pose, one vector per point.
  [[nodiscard]] StackedPoints Displacement(const Entry& entry, int value) const;
  // |d|^2 of a value; 0 if its reference pose does not move the points.
  [[nodiscard]] float SquaredDisplacement(const Entry& entry, int value) const {
    return squares_[entry.first_square + static_cast<std::uint32_t>(value)];
  }

 private:
  // Displacements before they are rounded: d = B_k - B_0 of one driver, value by value.
  using PreciseVectors = std::vector<glm::dvec3>;

  // Sets `entry->in_model_space`.
  [[nodiscard]] Status BindPoints(const std::string& name, const PoseDriver& driver,
                                  BindContext* context, Entry* entry, bool* usable);
  [[nodiscard]] Status BindValue(const std::string& name, const PoseDriver::Value& value,
                                 const Entry& entry, BindContext* context, PreciseVectors* precise);
  void BindGram(const std::string& name, const PoseDriver& driver, const PreciseVectors& precise,
                Entry* entry, BindContext* context);
  [[nodiscard]] BoundPose Bound(const Entry& entry) const;

  std::vector<Entry> entries_;
  std::vector<MeasuredPoint> points_;
  std::vector<glm::vec3> displacements_;  // d = B_k - B_0, anchor space
  std::vector<glm::vec3> projections_;    // d / dot(d, d)
  std::vector<float> squares_;            // dot(d, d), or 0 below the epsilon
  std::vector<double> inverse_lengths_;   // 1 / |d|, or 0
  std::vector<glm::dvec3> directions_;    // of nnls drivers: d / |d| (PoseGram)
  std::vector<NnlsTable> nnls_;           // of the directions
  PosePlan plan_;
};

}  // namespace furrow::wrinkle
