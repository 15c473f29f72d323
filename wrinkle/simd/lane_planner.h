// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/simd/point_plan.h"
#include "wrinkle/simd/row_gather.h"
#include "wrinkle/skeleton/joint_chain.h"

namespace furrow::wrinkle {

inline constexpr std::int32_t kLaneYes = -1;  // a set lane of a mask
inline constexpr std::int32_t kLaneNo = 0;

template <int kN>
void SetLane(const glm::vec<kN, float>& v, std::size_t lane, FloatRow* rows) {
  for (int i = 0; i < kN; ++i) rows[i].at[lane] = v[i];
}

// Sets the joint of one lane. kNoJoint: the lane's chain has ended; the lane then reads joint 0 and
// ignores it.
void SetJoint(int joint, std::size_t lane, JointStep* step);

// Up to sixteen indices, one per lane. Lanes past `count` read the first index.
struct Lanes {
  std::array<int, kRowLanes> at{};
  std::size_t count = 0;

  void Add(int index) { at[count++] = index; }
  [[nodiscard]] int operator[](std::size_t lane) const { return at[lane < count ? lane : 0]; }
};

// Distributes entries 0 to `count` - 1 over blocks. All lanes of a block have the same `kind`.
// Within a kind, entries are sorted by `length`, so that chains of one length share a block, and
// then by index.
template <class Kind, class Length>
std::vector<Lanes> InBlocks(std::size_t count, Kind kind, Length length) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {},
                           [&](int entry) { return std::pair(kind(entry), length(entry)); });
  std::vector<Lanes> blocks;
  for (const int entry : order) {
    if (blocks.empty() || blocks.back().count == kRowLanes ||
        kind(blocks.back()[0]) != kind(entry)) {
      blocks.emplace_back();
    }
    blocks.back().Add(entry);
  }
  return blocks;
}

// The `kind` for InBlocks() where all entries may share a block.
inline constexpr auto kOneKind = [](int) { return 0; };

// Lays out the drivers of a binding in lanes: adds points, reserves rows of the scratch memory, and
// records the place of each driver value. Each kind's driver set plans its own blocks with it.
// Private to wrinkle/.
class LanePlanner {
 public:
  // `num_values` driver values in all. The references outlive the planner.
  LanePlanner(const JointChains& chains, std::size_t num_values, PointPlan* plan)
      : chains_(chains), plan_(*plan), places_(num_values, 0) {}

  [[nodiscard]] const JointChains& chains() const { return chains_; }
  [[nodiscard]] PointPlan& plan() { return plan_; }

  // Adds a row with the given points of the chains. Returns the row's index.
  std::uint32_t AddPoints(const Lanes& points);
  // Reserves rows of the scratch memory. Returns the index of the first.
  std::uint32_t AddRows(std::size_t count) {
    return std::exchange(num_rows_, num_rows_ + static_cast<std::uint32_t>(count));
  }
  // Records that a driver's values are written to lane `lane` of the block's rows.
  void Place(int first_value, std::size_t num_values, std::size_t lane, Block* block);
  // Reserves rows for the values of a single driver, one after another.
  void PlaceSingle(SingleDriver* driver);

  // After all kinds: brings the values from the scratch memory into the order of the rig.
  [[nodiscard]] RowGather Values() const { return {places_, 0}; }
  [[nodiscard]] std::uint32_t num_rows() const { return num_rows_; }

 private:
  void AddStep(const Lanes& points, std::size_t index, bool up);

  const JointChains& chains_;
  PointPlan& plan_;
  std::vector<std::uint32_t> places_;  // of the rig's values, in the scratch memory
  std::uint32_t num_rows_ = 1;         // row 0 holds zeros
};

}  // namespace furrow::wrinkle
