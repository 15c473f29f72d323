// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/pose_plan.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace furrow::wrinkle {
namespace {

using BlockDrivers = std::span<const BoundPose* const>;

// 2 s^2 |d|^2. A pose that moves nothing has the value 0 whatever its width.
float FalloffWidth(const BoundPose& driver, std::size_t value) {
  const float square = driver.squares[value];
  return square > 0.0f ? 2.0f * driver.falloff * driver.falloff * square : 1.0f;
}

// Adds the points of a block. A driver with fewer points than the block repeats its first one.
void AddPoints(BlockDrivers drivers, LanePlanner* planner, PoseBlock* block) {
  block->first_point = static_cast<std::uint32_t>(planner->plan().points.size());
  for (std::size_t i = 0; i < block->num_points; ++i) {
    Lanes points;
    FloatRow rest[3];
    for (const BoundPose* driver : drivers) {
      const MeasuredPoint& point = driver->points[i < driver->points.size() ? i : 0];
      SetLane(point.rest, points.count, rest);
      points.Add(point.point);
    }
    std::copy(std::begin(rest), std::end(rest),
              planner->plan().points[planner->AddPoints(points)].rest);
  }
}

// Adds the blend shapes of a block, of which all drivers have the same number.
void AddShapes(BlockDrivers drivers, PosePlan* plan, PoseBlock* block) {
  block->first_shapes = static_cast<std::uint32_t>(plan->shapes.size());
  for (std::size_t i = 0; i < block->num_shapes; ++i) {
    ShapeRows& rows = plan->shapes.emplace_back();
    for (IntRow& row : rows.blend_shapes) std::ranges::fill(row.at, -1);
    for (std::size_t lane = 0; lane < drivers.size(); ++lane) {
      const MeasuredShapes& shapes = drivers[lane]->shapes[i];
      for (std::size_t k = 0; k < 3; ++k) {
        rows.blend_shapes[k].at[lane] = shapes.blend_shapes[k];
      }
      rows.unit.at[lane] = shapes.unit;
    }
  }
}

// The number of vectors in the stack of a block.
std::size_t NumVectors(const PoseBlock& block) {
  return std::size_t{block.num_points} + block.num_shapes;
}

// Missing points and values keep a projection of 0.
void AddProjections(BlockDrivers drivers, PosePlan* plan, PoseBlock* block) {
  block->first_projection = static_cast<std::uint32_t>(plan->projections.size());
  const std::size_t per_value = NumVectors(*block) * 3;
  plan->projections.resize(plan->projections.size() + block->num_values * per_value);
  for (std::size_t lane = 0; lane < drivers.size(); ++lane) {
    const BoundPose& driver = *drivers[lane];
    const std::size_t num_vectors = driver.points.size() + driver.shapes.size();
    for (std::size_t i = 0; i < driver.projections.size(); ++i) {
      // A driver's table is dense, the block's table is padded to the block's number of points.
      const std::size_t row = i / num_vectors * per_value + i % num_vectors * 3;
      SetLane(driver.projections[i], lane, &plan->projections[block->first_projection + row]);
    }
  }
}

// Per value: a row of widths, then three rows of d per vector. Unused lanes get the width 1,
// because the kernel divides by it.
void AddFalloffs(BlockDrivers drivers, PosePlan* plan, PoseBlock* block) {
  block->first_falloff = static_cast<std::uint32_t>(plan->falloffs.size());
  const std::size_t per_value = NumVectors(*block) * 3 + 1;
  plan->falloffs.resize(plan->falloffs.size() + block->num_values * per_value);
  for (std::size_t value = 0; value < block->num_values; ++value) {
    FloatRow* const rows = &plan->falloffs[block->first_falloff + value * per_value];
    std::ranges::fill(rows->at, 1.0f);
    for (std::size_t lane = 0; lane < drivers.size(); ++lane) {
      const BoundPose& driver = *drivers[lane];
      if (value >= driver.squares.size()) continue;
      rows->at[lane] = FalloffWidth(driver, value);
      const std::size_t num_vectors = driver.points.size() + driver.shapes.size();
      for (std::size_t i = 0; i < num_vectors; ++i) {
        SetLane(driver.displacements[value * num_vectors + i], lane, rows + 1 + 3 * i);
      }
    }
  }
}

// True if all chains are a single joint up, so that a LeafBlock describes the block.
bool IsLeafBlock(const PoseBlock& block, const PointPlan& points) {
  if (block.num_points != 1 || block.num_shapes > 0 || block.has_falloff) return false;
  const PointRow& row = points.points[block.first_point];
  return row.num_up == 1 && row.num_down == 0 && !row.is_origin &&
         points.steps[row.first_step].all_active;
}

LeafBlock MakeLeafBlock(const PoseBlock& block, const PointPlan& points) {
  const PointRow& row = points.points[block.first_point];
  LeafBlock leaf;
  static_cast<Block&>(leaf) = block;
  leaf.num_values = block.num_values;
  leaf.joints = points.steps[row.first_step].joints;
  std::copy(std::begin(row.offset), std::end(row.offset), leaf.offset);
  std::copy(std::begin(row.rest), std::end(row.rest), leaf.rest);
  leaf.first_projection = block.first_projection;
  return leaf;
}

void AddBlock(BlockDrivers drivers, LanePlanner* planner, PosePlan* plan) {
  PoseBlock block;
  block.has_falloff = drivers.front()->falloff > 0.0f;
  block.num_shapes = static_cast<std::uint32_t>(drivers.front()->shapes.size());
  for (const BoundPose* driver : drivers) {
    block.num_points =
        std::max(block.num_points, static_cast<std::uint32_t>(driver->points.size()));
    block.num_values =
        std::max(block.num_values, static_cast<std::uint32_t>(driver->squares.size()));
  }
  block.first_row = planner->AddRows(block.num_values);
  for (std::size_t lane = 0; lane < drivers.size(); ++lane) {
    planner->Place(drivers[lane]->first_value, drivers[lane]->squares.size(), lane, &block);
  }
  AddPoints(drivers, planner, &block);
  AddShapes(drivers, plan, &block);
  AddProjections(drivers, plan, &block);
  if (block.has_falloff) AddFalloffs(drivers, plan, &block);
  if (IsLeafBlock(block, planner->plan())) {
    plan->leaves.push_back(MakeLeafBlock(block, planner->plan()));
  } else {
    plan->blocks.push_back(block);
  }
}

}  // namespace

void PlanProjections(std::span<const BoundPose> drivers, LanePlanner* planner, PosePlan* plan) {
  const auto at = [&](int i) -> const BoundPose& { return drivers[static_cast<std::size_t>(i)]; };
  // A block does the work of its largest driver in every lane, so drivers of equal size share a
  // block.
  const auto length = [&](int i) {
    if (at(i).points.empty()) return std::array<std::size_t, 4>{0, at(i).squares.size(), 0, 0};
    const JointChains::Chain chain = planner->chains().chain(at(i).points.front().point);
    return std::array{at(i).points.size(), at(i).squares.size(), chain.down.size(),
                      chain.up.size()};
  };
  // A falloff measures the distance over all points: every lane must have the same number of them.
  // Points and blend shapes follow one another: every lane must have them at the same places.
  const auto kind = [&](int i) {
    const BoundPose& driver = at(i);
    const bool has_falloff = driver.falloff > 0.0f;
    const bool is_padded = !has_falloff && driver.shapes.empty();
    return std::array<std::size_t, 3>{has_falloff, driver.shapes.size(),
                                      is_padded ? 0 : driver.points.size()};
  };
  for (const Lanes& lanes : InBlocks(drivers.size(), kind, length)) {
    std::vector<const BoundPose*> block;
    for (std::size_t lane = 0; lane < lanes.count; ++lane) block.push_back(&at(lanes[lane]));
    AddBlock(block, planner, plan);
  }
}

// The points of all nnls drivers are planned one after another.
void PlanNnls(std::span<const BoundPose> drivers, std::span<const int> entries,
              LanePlanner* planner, PosePlan* plan) {
  std::vector<std::pair<const MeasuredPoint*, std::uint32_t>> points;  // and driver's first value
  for (std::size_t i = 0; i < drivers.size(); ++i) {
    const BoundPose& from = drivers[i];
    NnlsDriver driver;
    driver.entry = entries[i];
    driver.first_value = static_cast<std::uint32_t>(from.first_value);
    driver.num_values = static_cast<std::uint32_t>(from.squares.size());
    driver.first_lane = static_cast<std::uint32_t>(points.size());
    driver.num_lanes = static_cast<std::uint32_t>(from.points.size());
    driver.first_width = static_cast<std::uint32_t>(plan->widths.size());
    driver.has_falloff = from.falloff > 0.0f;
    plan->widths.resize(plan->widths.size() + NumRows(from.squares.size()));
    for (std::size_t k = 0; k < from.squares.size(); ++k) {
      plan->widths[driver.first_width + k / kRowLanes].at[k % kRowLanes] = FalloffWidth(from, k);
    }
    planner->PlaceSingle(&driver);
    plan->nnls.push_back(driver);
    for (const MeasuredPoint& point : from.points) points.emplace_back(&point, driver.first_value);
  }
  for (std::size_t first = 0; first < points.size(); first += kRowLanes) {
    Lanes lanes;
    FloatRow rest[3];
    for (std::size_t i = first; i < std::min(first + kRowLanes, points.size()); ++i) {
      SetLane(points[i].first->rest, lanes.count, rest);
      lanes.Add(points[i].first->point);
    }
    const std::uint32_t row = planner->AddPoints(lanes);
    std::copy(std::begin(rest), std::end(rest), planner->plan().points[row].rest);
    SinglePoints& block = plan->nnls_points.emplace_back();
    block.first_value = points[first].second;
    block.first_row = planner->AddRows(3);
    block.num_lanes = static_cast<std::uint32_t>(lanes.count);
    block.first_point = row;
  }
}

}  // namespace furrow::wrinkle
