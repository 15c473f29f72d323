// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/simd/lane_rows.h"

namespace furrow::wrinkle {

// A plan to pick numbers from fixed places of a list: which rows of the list to load for each
// output row, and which of their lanes to take. Performing the plan is many times faster than a
// processor's own gathers, which load one number after another. Private to wrinkle/.
// simd/lanes-inl.h performs it.
class RowGather {
 public:
  // Two rows of the list, and the source of each output lane: 0 to 15 for a lane of the first row,
  // 16 to 31 for a lane of the second row, negative for a lane that another step fills.
  struct Step {
    IntRow lanes;
    std::uint32_t first = 0;   // index of the first row's first number in the list
    std::uint32_t second = 0;  // the same for the second row
    // In a first step: the number of further steps for the same output row, which takes numbers
    // from more than two rows of the list, and the index of the first of them in more().
    std::uint32_t num_more = 0;
    std::uint32_t first_more = 0;
  };

  RowGather() = default;
  // `indices`: the index in the list of each number to pick. Rows of kRowLanes numbers are loaded,
  // so the list must be readable to the end of its last row. `filler`: an index, too; the lanes
  // after the last number, up to the end of the last output row, get the number there.
  RowGather(std::span<const std::uint32_t> indices, std::uint32_t filler);

  [[nodiscard]] std::size_t num_rows() const { return first_steps_.size(); }
  // One per output row. Most rows need no further steps.
  [[nodiscard]] const Step* first_steps() const { return first_steps_.data(); }
  [[nodiscard]] const Step* more() const { return more_.data(); }
  // The places themselves, kRowLanes per output row.
  [[nodiscard]] const std::uint32_t* indices() const { return indices_.data(); }

 private:
  void AddRow(std::span<const std::uint32_t> wanted);

  std::vector<std::uint32_t> indices_;
  std::vector<Step> first_steps_;
  std::vector<Step> more_;
};

}  // namespace furrow::wrinkle
