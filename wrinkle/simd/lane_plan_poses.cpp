// SPDX-License-Identifier: Apache-2.0
// Pose and strain drivers in a LanePlan: those side by side, and the points of those alone.
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

void LanePlanner::AddPoses() {
  const PoseDriverSet& drivers = data_.pose_drivers;
  std::vector<const PoseDriverSet::Entry*> all;
  for (const PoseDriverSet::Entry& entry : drivers.entries()) {
    if (entry.solve != PoseSolve::kNnls) all.push_back(&entry);
  }
  const auto length = [&](int i) {
    const auto chain = data_.chains.chain(drivers.points(*all[i]).front().point);
    return std::array{std::size_t{all[i]->num_points}, static_cast<std::size_t>(all[i]->num_values),
                      chain.down.size(), chain.up.size()};
  };
  // What a falloff leaves over is of as many points as there are: no lane may have more or less.
  const auto falloff_points = [&](int i) {
    return all[i]->falloff > 0.0f ? all[i]->num_points : 0;
  };
  for (const Lanes& lanes : InBlocks(all.size(), falloff_points, length)) {
    std::vector<const PoseDriverSet::Entry*> entries;
    for (std::size_t lane = 0; lane < lanes.count; ++lane) entries.push_back(all[lanes[lane]]);
    AddPoseBlock(entries);
  }
}

void LanePlanner::AddPoseBlock(PoseEntries entries) {
  PoseBlock block;
  block.has_falloff = entries.front()->falloff > 0.0f;
  for (const PoseDriverSet::Entry* entry : entries) {
    block.num_points = std::max(block.num_points, entry->num_points);
    block.num_values = std::max(block.num_values, static_cast<std::uint32_t>(entry->num_values));
  }
  block.first_row = AddRows(block.num_values);
  for (std::size_t lane = 0; lane < entries.size(); ++lane) {
    const PoseDriverSet::Entry& entry = *entries[lane];
    Place(entry.first_value, static_cast<std::size_t>(entry.num_values), lane, &block);
  }
  AddPosePoints(entries, &block);
  AddProjections(entries, &block);
  if (block.has_falloff) AddFalloffs(entries, &block);
  const PointRow& row = plan_.points[block.first_point];
  const bool is_one_step = row.num_up == 1 && row.num_down == 0 && !row.is_origin;
  if (block.num_points == 1 && !block.has_falloff && is_one_step &&
      plan_.steps[row.first_step].all_active) {
    AddLeafBlock(block);
  } else {
    plan_.poses.push_back(block);
  }
}

// Where a driver has fewer points than others of its block, its first one again.
void LanePlanner::AddPosePoints(PoseEntries entries, PoseBlock* block) {
  block->first_point = static_cast<std::uint32_t>(plan_.points.size());
  for (std::size_t i = 0; i < block->num_points; ++i) {
    Lanes points;
    FloatRow rest[3];
    for (const PoseDriverSet::Entry* entry : entries) {
      const auto& point = data_.pose_drivers.points(*entry)[i < entry->num_points ? i : 0];
      SetLane(point.rest, points.count, rest);
      points.Add(point.point);
    }
    std::copy(std::begin(rest), std::end(rest), plan_.points[AddPoints(points)].rest);
  }
}

void LanePlanner::AddLeafBlock(const PoseBlock& block) {
  const PointRow& row = plan_.points[block.first_point];
  LeafBlock& leaf = plan_.leaves.emplace_back();
  static_cast<Block&>(leaf) = block;
  leaf.num_values = block.num_values;
  leaf.joints = plan_.steps[row.first_step].joints;
  std::copy(std::begin(row.offset), std::end(row.offset), leaf.offset);
  std::copy(std::begin(row.rest), std::end(row.rest), leaf.rest);
  leaf.first_projection = block.first_projection;
}

// And they are 0 there, as where it has fewer values.
void LanePlanner::AddProjections(PoseEntries entries, PoseBlock* block) {
  block->first_projection = static_cast<std::uint32_t>(plan_.projections.size());
  const std::size_t per_value = std::size_t{block->num_points} * 3;
  plan_.projections.resize(plan_.projections.size() + block->num_values * per_value);
  for (std::size_t lane = 0; lane < entries.size(); ++lane) {
    const PoseDriverSet::Entry& entry = *entries[lane];
    for (int value = 0; value < entry.num_values; ++value) {
      FloatRow* row =
          &plan_.projections[block->first_projection + static_cast<std::size_t>(value) * per_value];
      for (const glm::vec3& projection : data_.pose_drivers.projections(entry, value)) {
        SetLane(projection, lane, row);
        row += 3;
      }
    }
  }
}

void LanePlanner::AddFalloffs(PoseEntries entries, PoseBlock* block) {
  block->first_falloff = static_cast<std::uint32_t>(plan_.falloffs.size());
  const std::size_t per_value = std::size_t{block->num_points} * 3 + 1;
  plan_.falloffs.resize(plan_.falloffs.size() + block->num_values * per_value);
  for (std::uint32_t value = 0; value < block->num_values; ++value) {
    FloatRow* const rows = &plan_.falloffs[block->first_falloff + value * per_value];
    std::ranges::fill(rows->at, 1.0f);
    for (std::size_t lane = 0; lane < entries.size(); ++lane) {
      const PoseDriverSet::Entry& entry = *entries[lane];
      if (static_cast<int>(value) >= entry.num_values) continue;
      const int driver = static_cast<int>(&entry - data_.pose_drivers.entries().data());
      const auto k = static_cast<int>(value);
      // Where the pose does not move the points, its value is 0 and the width does not count.
      const float square = data_.pose_drivers.SquaredDisplacement(driver, k);
      if (square > 0.0f) rows->at[lane] = 2.0f * entry.falloff * entry.falloff * square;
      FloatRow* row = rows + 1;
      for (const glm::vec3& d : data_.pose_drivers.Displacement(driver, k)) {
        SetLane(d, lane, row);
        row += 3;
      }
    }
  }
}

// The points of all such drivers, one after the other.
void LanePlanner::AddNnls() {
  const PoseDriverSet& drivers = data_.pose_drivers;
  std::vector<std::pair<int, std::uint32_t>>
      points;  // of JointChains, and its driver's first value
  std::vector<glm::vec3> rest;
  for (const int index : drivers.nnls_entries()) {
    const PoseDriverSet::Entry& entry = drivers.entries()[static_cast<std::size_t>(index)];
    LoneDriver driver{.entry = index,
                      .first_value = static_cast<std::uint32_t>(entry.first_value),
                      .num_values = static_cast<std::uint32_t>(entry.num_values),
                      .first_lane = static_cast<std::uint32_t>(points.size()),
                      .num_lanes = entry.num_points};
    PlaceAlone(&driver);
    plan_.nnls.push_back(driver);
    for (const auto& point : drivers.points(entry)) {
      points.emplace_back(point.point, driver.first_value);
      rest.push_back(point.rest);
    }
  }
  for (std::size_t first = 0; first < points.size(); first += kRowLanes) {
    Lanes lanes;
    FloatRow rows[3];
    for (std::size_t i = first; i < std::min(first + kRowLanes, points.size()); ++i) {
      SetLane(rest[i], lanes.count, rows);
      lanes.Add(points[i].first);
    }
    const std::uint32_t row = AddPoints(lanes);
    std::copy(std::begin(rows), std::end(rows), plan_.points[row].rest);
    LonePoints& block = plan_.nnls_points.emplace_back();
    block.first_value = points[first].second;
    block.first_row = AddRows(3);
    block.num_lanes = static_cast<std::uint32_t>(lanes.count);
    block.first_point = row;
  }
}

// The joints of all patches, one after the other.
void LanePlanner::AddStrains() {
  const StrainDriverSet& drivers = data_.strain_drivers;
  std::vector<std::pair<const int*, std::uint32_t>> frames;  // four points, and as above
  for (int i = 0; i < drivers.num_entries(); ++i) {
    const std::span<const int> points = drivers.points(i);
    LoneDriver driver{.entry = i,
                      .first_value = static_cast<std::uint32_t>(drivers.first_value(i)),
                      .num_values = StrainDriverSet::kNumValues,
                      .first_lane = static_cast<std::uint32_t>(frames.size()),
                      .num_lanes = static_cast<std::uint32_t>(points.size() / 4)};
    PlaceAlone(&driver);
    plan_.strains.push_back(driver);
    for (std::size_t k = 0; k < points.size(); k += 4) {
      frames.emplace_back(&points[k], driver.first_value);
    }
  }
  for (std::size_t first = 0; first < frames.size(); first += kRowLanes) {
    LonePoints& block = plan_.strain_frames.emplace_back();
    block.first_value = frames[first].second;
    block.first_row = AddRows(12);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      Lanes lanes;
      for (std::size_t i = first; i < std::min(first + kRowLanes, frames.size()); ++i) {
        lanes.Add(frames[i].first[corner]);
      }
      const std::uint32_t row = AddPoints(lanes);
      if (corner == 0) block.first_point = row;
      block.num_lanes = static_cast<std::uint32_t>(lanes.count);
    }
  }
}

}  // namespace furrow::wrinkle
