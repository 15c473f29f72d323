// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/blend_shape/blend_shape_driver.h"

namespace furrow::wrinkle {

Status BlendShapeDriverSet::Bind(const std::string& name, const BlendShapeDriver& driver,
                                 int first_value, BindContext* context) {
  const Result<int> found = context->BlendShape("driver '" + name + "'", driver.blend_shape);
  FURROW_RETURN_IF_ERROR(found);
  if (*found < 0) return {};
  entries_.push_back({.first_value = first_value,
                      .blend_shape = *found,
                      .neutral = driver.neutral,
                      .full = driver.full});
  names_.push_back(driver.blend_shape);
  return {};
}

void BlendShapeDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    explanation->shapes.push_back({.driver = pose.DriverName(entries_[i].first_value),
                                   .blend_shape = names_[i],
                                   .coefficient = pose.Coefficient(entries_[i].blend_shape)});
  }
}

void BlendShapeDriverSet::Plan(LanePlanner* planner) {
  for (const Lanes& lanes : InBlocks(entries_.size(), kOneKind, kOneKind)) {
    BlendShapeBlock& block = blocks_.emplace_back();
    block.first_row = planner->AddRows(1);
    // Idle lanes copy the block's first driver, so that they divide by a valid range. Only lanes in
    // use get a place.
    for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
      const Entry& entry = entries_[static_cast<std::size_t>(lanes[lane])];
      if (lane < lanes.count) planner->Place(entry.first_value, 1, lane, &block);
      block.blend_shape.at[lane] = entry.blend_shape;
      block.neutral.at[lane] = entry.neutral;
      block.range.at[lane] = entry.full - entry.neutral;
    }
  }
}

}  // namespace furrow::wrinkle
