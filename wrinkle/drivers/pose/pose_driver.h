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

// Control points stacked into one long vector: points of one driver, in one space and unit, and
// then its blend shapes, three coefficients per vector.
using StackedPoints = std::span<const glm::vec3>;

// All pose drivers of a binding: entries that index flat pools. Private to wrinkle/.
// pose_lanes-inl.h evaluates the drivers; this class solves nnls.
//
// Coefficients have no unit of length. In a driver that also has joints, they are multiplied by the
// largest displacement of a point in the driver's reference poses. In a driver of blend shapes
// alone, any unit gives the same values.
//
// Blend shapes that the stream lacks are left out of the stack, and so are joints if the stream has
// some blend shape of the driver. The reference poses then have the value 1 in what is left. A
// driver of joints alone rests at 0 if one of them is missing.
class PoseDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    int num_values = 0;
    std::uint32_t first_point = 0;  // into points_
    std::uint32_t num_points = 0;
    std::uint32_t first_shapes = 0;  // into shapes_
    std::uint32_t num_shapes = 0;
    std::uint32_t first_displacement = 0;  // into displacements_: num_values x num_vectors()
    std::uint32_t first_square = 0;        // into squares_: num_values
    std::uint32_t nnls = 0;                // into nnls_, for PoseSolve::kNnls
    std::uint32_t first_direction = 0;     // into directions_, for PoseSolve::kNnls
    PoseSolve solve = PoseSolve::kProjection;
    float falloff = 0.0f;
    bool in_model_space = false;  // no anchor: points are in the model space of poses
    // Of the stack: points, then triples of blend shapes.
    [[nodiscard]] std::uint32_t num_vectors() const { return num_points + num_shapes; }
  };

  // Adds a driver with values that begin at `first_value` of the binding's driver values.
  [[nodiscard]] Status Bind(const std::string& name, const PoseDriver& driver, int first_value,
                            BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the geometry of each value.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  // Writes the part of the stack that blend shapes move; returns the number of vectors.
  // `coefficients`: the stream's; missing ones count as 0.
  std::size_t MoveShapes(int entry, std::span<const float> coefficients,
                         std::span<glm::vec3> moved) const;
  // The nnls weights of an entry's reference poses, not clamped. `moved`: the stack's departure
  // from rest.
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
  [[nodiscard]] std::span<const MeasuredShapes> shapes(const Entry& entry) const {
    return std::span(shapes_).subspan(entry.first_shapes, entry.num_shapes);
  }
  // The displacement d of value `value`: from rest to its reference pose, vector by vector.
  [[nodiscard]] StackedPoints Displacement(const Entry& entry, int value) const;
  // |d|^2 of a value; 0 if its reference pose moves nothing that the driver measures.
  [[nodiscard]] float SquaredDisplacement(const Entry& entry, int value) const {
    return squares_[entry.first_square + static_cast<std::uint32_t>(value)];
  }

 private:
  // Displacements before they are rounded: d = B_k - B_0 of one driver, value by value.
  using PreciseVectors = std::vector<glm::dvec3>;

  // Finds what of the driver the stream has. `usable`: enough to measure it.
  [[nodiscard]] Status BindShapes(const std::string& name, const PoseDriver& driver,
                                  BindContext* context, Entry* entry);
  // Sets `entry->in_model_space` too.
  [[nodiscard]] Status BindPoints(const std::string& name, const PoseDriver& driver,
                                  BindContext* context, Entry* entry, bool* usable);
  // The length that a coefficient of 1 counts as.
  [[nodiscard]] float ShapeUnit(const PoseDriver& driver, const Entry& entry,
                                const BindContext& context) const;
  [[nodiscard]] Status BindValue(const std::string& name, const PoseDriver::Value& value,
                                 const Entry& entry, BindContext* context, PreciseVectors* precise);
  void BindGram(const std::string& name, const PoseDriver& driver, const PreciseVectors& precise,
                Entry* entry, BindContext* context);
  [[nodiscard]] BoundPose Bound(const Entry& entry) const;
  void ExplainShapes(const Entry& entry, const SolvedPose& pose,
                     DriverExplanation* explanation) const;

  std::vector<Entry> entries_;
  std::vector<MeasuredPoint> points_;
  std::vector<MeasuredShapes> shapes_;
  std::vector<std::string> shape_names_;  // three per entry of shapes_; "" for none
  std::vector<glm::vec3> displacements_;  // d = B_k - B_0, anchor space
  std::vector<glm::vec3> projections_;    // d / dot(d, d)
  std::vector<float> squares_;            // dot(d, d), or 0 below the epsilon
  std::vector<double> inverse_lengths_;   // 1 / |d|, or 0
  std::vector<glm::dvec3> directions_;    // of nnls drivers: d / |d| (PoseGram)
  std::vector<NnlsTable> nnls_;           // of the directions
  PosePlan plan_;
};

}  // namespace furrow::wrinkle
