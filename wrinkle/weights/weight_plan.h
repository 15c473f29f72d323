// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/simd/row_gather.h"
#include "wrinkle/weights/modulation_row.h"
#include "wrinkle/weights/weight_table.h"

namespace furrow::wrinkle {

// A WeightTable laid out for sixteen weights side by side, one per lane; weight_lanes-inl.h reads
// it. Private to wrinkle/.

// Up to sixteen weights. Masks hold -1 or 0 per lane.
struct WeightBlock {
  std::uint32_t first_source = 0;  // row of WeightPlan::sources and ::gains
  std::uint32_t num_sources = 0;   // of the weight with the most sources
  std::uint32_t first_opponent = 0;
  std::uint32_t num_opponents = 0;
  FloatRow scale;  // factor for the sum of the sources; unused in lanes that take the largest
  IntRow is_max;
  IntRow is_sum_modulated;
  ModulationRow modulation;
  bool all_max = true;
  bool any_sum_modulated = false;
  bool takes_largest = true;  // every weight is the largest of its driver values, all gains 1
};

struct WeightPlan {
  std::vector<WeightBlock> blocks;
  RowGather sources;            // out of the driver values
  std::vector<FloatRow> gains;  // 0 past a weight's last source
  // Out of the modulated weights. They are followed by a row of zeros, which stands for no
  // opponent.
  RowGather opponents;

  [[nodiscard]] std::size_t num_rows() const {
    return blocks.size() + 1;
  }  // modulated weights and zeros
};

// Lays `table` out in blocks of sixteen weights.
[[nodiscard]] WeightPlan MakeWeightPlan(const WeightTable& table);

}  // namespace furrow::wrinkle
