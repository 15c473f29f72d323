// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "wrinkle/drivers/blend_shape/blend_shape_fields.h"
#include "wrinkle/drivers/common/bind_context.h"
#include "wrinkle/drivers/common/driver_explanation.h"
#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

// Up to sixteen blend-shape drivers, one per lane.
struct BlendShapeBlock : Block {
  IntRow blend_shape;  // index into the stream's coefficients
  FloatRow neutral;
  FloatRow range;  // full - neutral
};

// All blend-shape drivers of a binding. Private to wrinkle/. blend_shape_lanes-inl.h evaluates
// them.
class BlendShapeDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    int blend_shape = 0;  // index into the stream's coefficients
    float neutral = 0.0f;
    float full = 1.0f;
  };

  [[nodiscard]] Status Bind(const std::string& name, const BlendShapeDriver& driver,
                            int first_value, BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the coefficients.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] const std::vector<BlendShapeBlock>& blocks() const { return blocks_; }

 private:
  std::vector<Entry> entries_;
  std::vector<std::string> names_;  // of the entries' blend shapes, as in the rig
  std::vector<BlendShapeBlock> blocks_;
};

}  // namespace furrow::wrinkle
