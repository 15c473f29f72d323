// SPDX-License-Identifier: Apache-2.0
// Evaluates pose drivers, one driver per SIMD lane: thesis 4.1 with dot(d, d) in the denominator
// (docs/ALGORITHM.md). x is the displacement of a driver's control points from rest in this pose
// and the coefficients of its blend shapes in their unit, d the same in a reference pose. Drivers
// of PoseSolve::kNnls have their points in lanes and are then solved one by one.
#if defined(FURROW_WRINKLE_POSE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_POSE_LANES_INL_H_
#undef FURROW_WRINKLE_POSE_LANES_INL_H_
#else
#define FURROW_WRINKLE_POSE_LANES_INL_H_
#endif

#include <array>

#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/simd/lane_math-inl.h"
#include "wrinkle/simd/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// x of a control point: its displacement from rest, in the anchor's space.
template <bool kScaled>
HWY_INLINE Float3 MovePoint(const PointPlan& plan, const PointRow& row, LanePose<kScaled> pose,
                            std::size_t lane) {
  return EvaluatePoint(plan, row, pose, lane) - LoadRows(row.rest, lane);
}

// x of three blend shapes.
HWY_INLINE Float3 MoveShapes(const ShapeRows& rows, std::span<const float> coefficients,
                             std::size_t lane) {
  return LoadRow(rows.unit, lane) *
         Float3{LoadCoefficients(coefficients, rows.blend_shapes[0], lane),
                LoadCoefficients(coefficients, rows.blend_shapes[1], lane),
                LoadCoefficients(coefficients, rows.blend_shapes[2], lane)};
}

// Writes clamp(dot(x, d) / dot(d, d), 0, 1) of each value to consecutive rows from `values` on, for
// drivers with one point and no falloff. Everything stays in registers.
template <bool kScaled>
void EvaluateOnePoint(const PosePlan& plan, const PointPlan& points, const PoseBlock& block,
                      LanePose<kScaled> pose, std::size_t lane, float* values) {
  const Float3 moved = MovePoint(points, points.points[block.first_point], pose, lane);
  const FloatRow* projection = plan.projections.data() + block.first_projection;
  for (std::uint32_t k = 0; k < block.num_values; ++k, projection += 3, values += kRowLanes) {
    StoreLanes(Saturate(Dot(moved, LoadRows(projection, lane))), values);
  }
}

// Does what EvaluateOnePoint() does, for the drivers whose point is on a child joint of the anchor.
// Loads the joints of the next block before it computes the values of this one, because processors
// do not look that far ahead.
template <bool kScaled>
void EvaluateLeaves(const PosePlan& plan, LanePose<kScaled> pose, std::size_t num_values,
                    float* rows) {
  const FloatRow* const projections = plan.projections.data();
  const LeafBlock* const end = plan.leaves.data() + plan.leaves.size();
  // Skips the blocks beyond the level of detail, so that the load ahead never touches them.
  const auto reached = [=](const LeafBlock* leaf) {
    while (leaf != end && leaf->first_value >= num_values) ++leaf;
    return leaf;
  };
  const LeafBlock* const first = reached(plan.leaves.data());
  if (first == end) return;
  // Computes whole rows without a mask: idle lanes repeat the block's first driver, and nothing
  // reads their values.
  for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes) {
    JointLanes next = LoadJoint(pose.numbers, first->joints.at + lane);
    for (const LeafBlock* leaf = first; leaf != end;) {
      const LeafBlock& now = *leaf;
      const JointLanes joint = next;
      leaf = reached(leaf + 1);
      if (leaf != end) next = LoadJoint(pose.numbers, leaf->joints.at + lane);
      const Float3 moved = Up(pose, now.joints.at + lane, joint, LoadRows(now.offset, lane)) -
                           LoadRows(now.rest, lane);
      const FloatRow* projection = projections + now.first_projection;
      float* to = rows + now.first_row * kRowLanes + lane;
      for (std::uint32_t k = 0; k < now.num_values; ++k, projection += 3, to += kRowLanes) {
        StoreLanes(Saturate(Dot(moved, LoadRows(projection, lane))), to);
      }
    }
  }
}

// The falloff exp(-|x - t d|^2 / (2 s^2 |d|^2)) with t = `along` and the driver's `falloff` s.
// `moved`: x, vector by vector. `rows`: the width 2 s^2 |d|^2, then three rows of d per vector.
inline Float Falloff(std::span<const Float3> moved, const FloatRow* rows, Float along,
                     std::size_t lane) {
  Float sum = hn::Zero(Floats());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Float3 difference = moved[i] - along * LoadRows(rows + 1 + 3 * i, lane);
    sum = hn::Add(sum, Dot(difference, difference));
  }
  return NegativeExponential(hn::Div(sum, LoadRow(*rows, lane)));
}

// Writes clamp(t, 0, 1) * falloff of each value to consecutive rows from `values` on, with
// t = dot(x, d) / dot(d, d) over all points: the general case of several points, of blend shapes,
// or of a falloff. `coefficients`: the stream's.
template <bool kScaled>
void EvaluatePoints(const PosePlan& plan, const PointPlan& points, const PoseBlock& block,
                    LanePose<kScaled> pose, std::span<const float> coefficients, std::size_t lane,
                    float* values) {
  std::array<Float3, kMaxControlPoints> moved_points;
  const std::span<Float3> moved(moved_points.data(), block.num_points + block.num_shapes);
  for (std::size_t i = 0; i < block.num_points; ++i) {
    moved[i] = MovePoint(points, points.points[block.first_point + i], pose, lane);
  }
  for (std::size_t i = 0; i < block.num_shapes; ++i) {
    moved[block.num_points + i] =
        MoveShapes(plan.shapes[block.first_shapes + i], coefficients, lane);
  }
  const FloatRow* projection = plan.projections.data() + block.first_projection;
  const FloatRow* falloff = plan.falloffs.data() + block.first_falloff;
  for (std::uint32_t k = 0; k < block.num_values; ++k, values += kRowLanes) {
    Float along = hn::Zero(Floats());
    for (const Float3& m : moved) {
      along = hn::Add(along, Dot(m, LoadRows(projection, lane)));
      projection += 3;
    }
    Float value = Saturate(along);
    if (block.has_falloff) {
      value = Saturate(hn::Mul(value, Falloff(moved, falloff, along, lane)));
      falloff += 1 + 3 * moved.size();
    }
    StoreLanes(value, values);
  }
}

// Solves one driver of PoseSolve::kNnls from its points, which are in `rows` already, and writes
// its values to `rows` from driver.first_number on, one after another.
inline void EvaluateNnls(const PoseDriverSet& drivers, const NnlsDriver& driver,
                         std::span<const float> coefficients, float* rows) {
  const PosePlan& plan = drivers.plan();
  std::array<glm::vec3, kMaxControlPoints> points;
  // Lanes of nnls points are counted over all blocks, because one driver's points may straddle two
  // blocks.
  for (std::size_t i = 0; i < driver.num_lanes; ++i) {
    const std::size_t lane = driver.first_lane + i;
    points[i] = StoredPoint(plan.nnls_points[lane / kRowLanes], lane % kRowLanes, 0, rows);
  }
  const std::size_t num_shapes =
      drivers.MoveShapes(driver.entry, coefficients, std::span(points).subspan(driver.num_lanes));
  const std::span<const glm::vec3> moved = std::span(points).first(driver.num_lanes + num_shapes);
  // The solver writes to the driver's own rows, and the loop below reads whole vectors from there.
  // Lanes past num_values are padding of these rows.
  float* const values = rows + driver.first_number;
  const std::span<float> along(values, driver.num_values);
  drivers.SolveNnls(driver.entry, moved, along);
  Float residual = hn::Zero(Floats());
  if (driver.has_falloff) residual = Splat(drivers.SquaredResidual(driver.entry, moved, along));
  for (std::size_t i = 0; i < driver.num_values; i += kLanes) {
    Float value = Saturate(LoadLanes(values + i));
    if (driver.has_falloff) {
      const FloatRow& width = plan.widths[driver.first_width + i / kRowLanes];
      const Float exponent = hn::Div(residual, LoadRow(width, i % kRowLanes));
      value = Saturate(hn::Mul(value, NegativeExponential(exponent)));
    }
    StoreLanes(value, values + i);
  }
}

// Writes the values of all drivers of `drivers` to the scratch memory `rows` (kRowLanes floats per
// row): row b.first_row + k of block b holds value k, lane l that of its driver l. Values of nnls
// drivers take consecutive floats instead.
template <bool kScaled>
void EvaluateDrivers(const PoseDriverSet& drivers, const PointPlan& points, LanePose<kScaled> pose,
                     const DriverInput& input, float* rows) {
  const PosePlan& plan = drivers.plan();
  EvaluateLeaves(plan, pose, input.num_values, rows);
  ForEachBlock(plan.blocks, input.num_values, rows,
               [&](const PoseBlock& block, std::size_t lane, float* to) HWY_ATTR {
                 if (block.num_points == 1 && block.num_shapes == 0 && !block.has_falloff) {
                   EvaluateOnePoint(plan, points, block, pose, lane, to);
                 } else {
                   EvaluatePoints(plan, points, block, pose, input.blend_shapes, lane, to);
                 }
               });
  ForEachBlock(plan.nnls_points, input.num_values, rows,
               [&](const SinglePoints& block, std::size_t lane, float* to) HWY_ATTR {
                 StoreRows(MovePoint(points, points.points[block.first_point], pose, lane), to);
               });
  // After all points are stored.
  for (const NnlsDriver& driver : plan.nnls) {
    if (driver.first_value < input.num_values)
      EvaluateNnls(drivers, driver, input.blend_shapes, rows);
  }
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
