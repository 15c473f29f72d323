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

#include "wrinkle/simd/lane_plan.h"
#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {

// Makes a LanePlan: which drivers share a block, and where things go. Private to wrinkle/.

template <int kN>
void SetLane(const glm::vec<kN, float>& v, std::size_t lane, FloatRow* rows) {
  for (int i = 0; i < kN; ++i) rows[i].at[lane] = v[i];
}

// Up to sixteen indices, one a lane; the first one again where there is none.
struct Lanes {
  std::array<int, kRowLanes> at{};
  std::size_t count = 0;

  void Add(int index) { at[count++] = index; }
  [[nodiscard]] int operator[](std::size_t lane) const { return at[lane < count ? lane : 0]; }
};

// Entries 0 to `count` - 1 in blocks: by their `kind`, which lanes of a block share, then by
// `length`, so that those whose loops are equally long share a block, then in order.
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

// Of a PoseDriverSet.
using PoseEntries = std::span<const PoseDriverSet::Entry* const>;

class LanePlanner {
 public:
  explicit LanePlanner(const BindingData& data)
      : data_(data), places_(static_cast<std::size_t>(data.first_values.back()), 0) {}

  LanePlan Plan() && {
    AddPoses();
    AddHinges();
    AddBalls();
    AddTwists();
    AddBlendShapes();
    AddNnls();
    AddStrains();
    plan_.values = RowGather(places_, 0);
    return std::move(plan_);
  }

 private:
  void AddPoses();
  void AddPoseBlock(PoseEntries entries);
  void AddPosePoints(PoseEntries entries, PoseBlock* block);
  void AddLeafBlock(const PoseBlock& block);
  void AddProjections(PoseEntries entries, PoseBlock* block);
  void AddFalloffs(PoseEntries entries, PoseBlock* block);
  void AddHinges();
  void AddBalls();
  void AddTwists();
  void AddTwistStep(const Lanes& lanes, std::size_t index);
  void AddBlendShapes();
  void AddNnls();
  void AddStrains();

  // Points of the binding's JointChains: the row's index.
  std::uint32_t AddPoints(const Lanes& points);
  void AddStep(const Lanes& points, std::size_t index, bool up);
  // Rows of the scratch memory: the first one's index.
  std::uint32_t AddRows(std::size_t count) {
    return std::exchange(plan_.num_rows, plan_.num_rows + static_cast<std::uint32_t>(count));
  }
  // A driver's values come to one lane of the block's rows.
  void Place(int first_value, std::size_t num_values, std::size_t lane, Block* block);
  // They come to rows of their own, one after the other.
  void PlaceAlone(LoneDriver* driver);
  template <class Entry>
  auto LengthOfBones(std::span<const Entry> entries) const;
  // What hinges and balls have in common.
  template <class Entry>
  void BindBones(std::span<const Entry> entries, const Lanes& lanes, std::size_t num_values,
                 BoneBlock* block);

  const BindingData& data_;
  LanePlan plan_;
  std::vector<std::uint32_t> places_;  // of the rig's values, in the scratch memory
};

}  // namespace furrow::wrinkle
