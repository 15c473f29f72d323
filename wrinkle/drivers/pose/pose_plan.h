// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

// Bound pose drivers laid out in lanes; pose_lanes-inl.h reads the tables. Private to wrinkle/.

// A control point of a bound driver.
struct MeasuredPoint {
  int point = 0;         // into the binding's JointChains
  glm::vec3 rest{0.0f};  // B_0, anchor space
};

// Three coefficients of a bound driver, which are one vector of its stack: `unit` times the
// coefficients.
struct MeasuredShapes {
  std::array<int, 3> blend_shapes{-1, -1, -1};  // into the stream's coefficients; -1: always 0
  float unit = 1.0f;
};

// What the planner needs of one bound driver. K values; a stack of P points and S triples of blend
// shapes. Tables are value by value.
struct BoundPose {
  int first_value = 0;
  std::span<const MeasuredPoint> points;     // P
  std::span<const MeasuredShapes> shapes;    // S
  std::span<const glm::vec3> projections;    // K x (P + S): d / dot(d, d)
  std::span<const glm::vec3> displacements;  // K x (P + S): d
  std::span<const float> squares;            // K: dot(d, d), or 0 for a pose that moves nothing
  float falloff = 0.0f;
};

// Projections. A lane with fewer points or values than its block has zeros for the others. In a
// block with blend shapes, all drivers have the same numbers of points and triples.
struct PoseBlock : Block {
  std::uint32_t first_point = 0;  // num_points rows of PointPlan::points
  std::uint32_t num_points = 0;
  std::uint32_t first_shapes = 0;  // num_shapes entries of PosePlan::shapes
  std::uint32_t num_shapes = 0;    // triples
  std::uint32_t num_values = 0;
  // Into PosePlan::projections: three rows per value and vector of the stack.
  std::uint32_t first_projection = 0;
  std::uint32_t first_falloff = 0;  // into PosePlan::falloffs
  bool has_falloff = false;
};

// Projections without falloff, of drivers with one control point on a child joint of the anchor.
// Most drivers of a face are such.
struct LeafBlock : Block {
  std::uint32_t num_values = 0;
  IntRow joints;
  FloatRow offset[3];
  FloatRow rest[3];
  std::uint32_t first_projection = 0;
};

// A triple of blend shapes of each lane: MeasuredShapes.
struct ShapeRows {
  IntRow blend_shapes[3];
  FloatRow unit;
};

// A driver that solves nnls, with its falloff.
struct NnlsDriver : SingleDriver {
  std::uint32_t first_width = 0;  // into PosePlan::widths: a row per sixteen values
  bool has_falloff = false;
};

struct PosePlan {
  std::vector<LeafBlock> leaves;
  std::vector<PoseBlock> blocks;
  std::vector<ShapeRows> shapes;
  std::vector<FloatRow> projections;
  std::vector<FloatRow>
      falloffs;  // per value: the width 2 s^2 |d|^2, then three rows of d per vector
  // How far the control points of nnls drivers have moved from rest: three rows per block.
  std::vector<SinglePoints> nnls_points;
  std::vector<NnlsDriver> nnls;
  std::vector<FloatRow> widths;
};

void PlanProjections(std::span<const BoundPose> drivers, LanePlanner* planner, PosePlan* plan);
// `entries`: the index of each driver in its PoseDriverSet.
void PlanNnls(std::span<const BoundPose> drivers, std::span<const int> entries,
              LanePlanner* planner, PosePlan* plan);

}  // namespace furrow::wrinkle
