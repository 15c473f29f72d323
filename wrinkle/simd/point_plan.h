// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/simd/lane_rows.h"

namespace furrow::wrinkle {

// Tables for the evaluation of sixteen drivers of a kind side by side, one driver per SIMD lane.
// They are made when a rig is bound (lane_planner.h) and read by the kernel. Private to wrinkle/.
//
// - Drivers write their values to rows of the scratch memory: one row per value, one lane per
//   driver. Row 0 holds zeros, for drivers that rest.
// - A lane without a driver repeats the joints of the block's first driver. Nothing reads its
//   values.

// One joint of each lane's chain.
struct JointStep {
  IntRow joints;  // index of the joint's first number in the pose
  IntRow active;  // -1 if the lane's chain has a joint here, else 0
  bool all_active = true;
};

// One point per lane (JointChains).
struct PointRow {
  FloatRow offset[3];
  FloatRow rest[3];              // position in the rest pose; only pose drivers set it
  std::uint32_t first_step = 0;  // into PointPlan::steps
  std::uint16_t num_up = 0;      // steps towards the root,
  std::uint16_t num_down = 0;    // and then steps away from it
  bool is_origin = false;  // every point is its joint's origin: the first step needs no rotation
};

// The points of all drivers of a binding.
struct PointPlan {
  std::vector<JointStep> steps;
  std::vector<PointRow> points;
};

// Up to sixteen drivers of one kind. Kinds derive their own blocks from it.
struct Block {
  std::uint32_t first_value = 0;  // lowest first value of its drivers; a level of detail that ends
                                  // before it skips the block
  std::uint32_t first_row = 0;    // of its values, in the scratch memory
  std::uint32_t num_lanes = 0;
};

// A driver that is solved by itself, because it branches too much for lanes. Only its points are
// evaluated side by side, with the points of the other drivers like it.
struct SingleDriver {
  int entry = 0;                  // index in its kind's driver set
  std::uint32_t first_value = 0;  // the rig's
  std::uint32_t num_values = 0;
  std::uint32_t first_number = 0;  // of its values, in the scratch memory; the start of a row
  std::uint32_t first_lane = 0;    // of its points, counted over all blocks of points of its kind
  std::uint32_t num_lanes = 0;
};

// The points of single drivers, sixteen per block.
struct SinglePoints : Block {
  std::uint32_t first_point = 0;  // into PointPlan::points
};

// What drivers read besides the joints.
struct DriverInput {
  // Level of detail: blocks that begin at this driver value or later are skipped.
  std::size_t num_values = 0;
  std::span<const float> blend_shapes;  // the stream's coefficients
};

}  // namespace furrow::wrinkle
