// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/rig/rig.h"
#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/simd/row_gather.h"

namespace furrow::wrinkle {

struct BindingData;

// A rig's drivers laid out so that sixteen of a kind are evaluated side by side, one a lane: what
// batch_drivers-inl.h and batch_poses-inl.h read. Lanes for which no driver is left repeat the
// first one's joints, and nobody reads what they come to. Private to wrinkle/.
//
// - A block holds up to sixteen drivers. It is left out where the level of detail ends before the
//   first of their values.
// - Values come out in rows of the scratch memory, a row for each value of the block's drivers;
//   `values` brings them into the order of the rig. Row 0 holds zeros, for drivers that rest.

// One joint of each lane's chain, as the place of its first number in the pose.
struct JointStep {
  IntRow joints;
  IntRow active;  // -1 where the lane's chain has a joint here, else 0
  bool all_active = true;
};

// Points of JointChains, and where each is at rest.
struct PointRow {
  FloatRow offset[3];
  FloatRow rest[3];
  std::uint32_t first_step = 0;  // into LanePlan::steps
  std::uint16_t num_up = 0;
  std::uint16_t num_down = 0;
  bool is_origin = false;  // all are their joints' origins: the first steps need no rotation
};

struct Block {
  std::uint32_t first_value = 0;  // of its drivers' the lowest; the level of detail goes by it
  std::uint32_t first_row = 0;    // of those that its values come to
  std::uint32_t num_lanes = 0;
};

struct PoseBlock : Block {
  std::uint32_t first_point = 0;  // num_points rows of LanePlan::points
  std::uint32_t num_points = 0;
  std::uint32_t num_values = 0;
  // Into LanePlan::projections, d / dot(d, d): three rows for each point, value by value.
  std::uint32_t first_projection = 0;
  // Into LanePlan::falloffs: for each value the width 2 s^2 |d|^2, then three rows of d a point.
  std::uint32_t first_falloff = 0;
  bool has_falloff = false;
};

// Pose drivers of one control point each that hangs from the base by a single joint, without
// falloff: those of most faces.
struct LeafBlock : Block {
  std::uint32_t num_values = 0;
  IntRow joints;
  FloatRow offset[3];
  FloatRow rest[3];
  std::uint32_t first_projection = 0;  // as a PoseBlock's
};

struct BoneBlock : Block {
  std::uint32_t joint_point = 0;  // into LanePlan::points
  std::uint32_t end_point = 0;
  FloatRow bend_scale;
};

struct HingeBlock : BoneBlock {
  FloatRow axis[3];
  IntRow has_axis;  // -1 or 0
};

struct BallBlock : BoneBlock {
  FloatRow straight[3];
  IntRow has_straight;  // -1 or 0: the upper bone's direction
  FloatRow forward[3];
  FloatRow right[3];
  BallMode mode = BallMode::kSmooth;
};

struct TwistStep {
  JointStep joint;
  FloatRow rest_inverse[4];
  FloatRow axis[3];
};

struct TwistBlock : Block {
  std::uint32_t first_step = 0;  // into LanePlan::twist_steps
  std::uint32_t num_steps = 0;
  FloatRow inverse_full;
};

struct BlendShapeBlock : Block {
  IntRow blend_shape;
  FloatRow neutral;
  FloatRow range;
};

// Drivers that branch too much to go side by side. Their points do, and stay in the scratch memory.
struct LonePoints : Block {
  std::uint32_t first_point = 0;  // into LanePlan::points
};

struct LoneDriver {
  int entry = 0;                  // of PoseDriverSet or StrainDriverSet
  std::uint32_t first_value = 0;  // the rig's
  std::uint32_t num_values = 0;
  std::uint32_t first_number = 0;  // of its values, in the scratch memory
  std::uint32_t first_lane = 0;    // of its points, counted from the first of all of its kind
  std::uint32_t num_lanes = 0;
};

struct LanePlan {
  std::vector<JointStep> steps;
  std::vector<PointRow> points;
  std::vector<FloatRow> projections;
  std::vector<FloatRow> falloffs;
  std::vector<TwistStep> twist_steps;

  std::vector<LeafBlock> leaves;
  std::vector<PoseBlock> poses;
  std::vector<HingeBlock> hinges;
  std::vector<BallBlock> balls;
  std::vector<TwistBlock> twists;
  std::vector<BlendShapeBlock> blend_shapes;

  // A point row each, which comes to three rows: how far the points have moved from rest.
  std::vector<LonePoints> nnls_points;
  std::vector<LoneDriver> nnls;
  // Four point rows each, a joint a lane: what it makes of the patch's centre and axes
  // (StrainDriverSet). They come to twelve rows.
  std::vector<LonePoints> strain_frames;
  std::vector<LoneDriver> strains;
  [[nodiscard]] bool HasLoneDrivers() const { return !nnls.empty() || !strains.empty(); }

  RowGather values;            // all of the rig's, out of the rows
  std::uint32_t num_rows = 1;  // of the scratch memory
};

// `data`: all drivers are bound.
[[nodiscard]] LanePlan MakeLanePlan(const BindingData& data);

}  // namespace furrow::wrinkle
