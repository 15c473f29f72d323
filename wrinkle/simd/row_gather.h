// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/simd/lane_rows.h"

namespace furrow::wrinkle {

// Numbers picked out of a list, always from the same places: which rows of it to load for each row
// that comes out, and which lanes to take. Processors' own gathers take many times as long, one
// number after another. Private to wrinkle/; carried out by batch_lanes-inl.h.
class RowGather {
 public:
  // Two rows of the list, and which of their lanes goes to each lane of what comes out: in the low
  // bits, the second row's after the first one's; negative where another step's goes there.
  struct Step {
    IntRow lanes;
    std::uint32_t first = 0;  // where the rows begin in the list
    std::uint32_t second = 0;
    // Of a first step: how many others there are for the same row, and where they begin in more().
    std::uint32_t num_more = 0;
    std::uint32_t first_more = 0;
  };

  RowGather() = default;
  // `indices` of the list, which is read in whole rows; what comes out fills whole rows with the
  // number at `filler`.
  RowGather(std::span<const std::uint32_t> indices, std::uint32_t filler);

  [[nodiscard]] std::size_t num_rows() const { return first_steps_.size(); }
  // One for each row that comes out. Most need no more than that.
  [[nodiscard]] const Step* first_steps() const { return first_steps_.data(); }
  [[nodiscard]] const Step* more() const { return more_.data(); }
  // The places themselves, kRowLanes for each row.
  [[nodiscard]] const std::uint32_t* indices() const { return indices_.data(); }

 private:
  void AddRow(std::span<const std::uint32_t> wanted);

  std::vector<std::uint32_t> indices_;
  std::vector<Step> first_steps_;
  std::vector<Step> more_;
};

}  // namespace furrow::wrinkle
