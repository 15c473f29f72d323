// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/simd/row_gather.h"
#include "wrinkle/weights/weight_table.h"

namespace furrow::wrinkle {

// A WeightTable laid out so that sixteen weights are made side by side, one a lane: what
// batch_weights-inl.h reads. Private to wrinkle/.

// Up to sixteen weights. Masks are -1 or 0 a lane.
struct WeightBlock {
  std::uint32_t first_source = 0;  // row of WeightPlan::sources and ::gains
  std::uint32_t num_sources = 0;   // of the weight that has the most
  std::uint32_t first_opponent = 0;
  std::uint32_t num_opponents = 0;
  FloatRow scale;  // what the sum of sources is multiplied by, unless the largest is taken
  IntRow is_max;
  IntRow is_cosine;
  IntRow is_cubic;
  bool all_max = true;
  bool all_cosine = true;
  bool any_cubic = false;
  bool takes_largest = true;  // of the sources, with no gain
};

struct WeightPlan {
  std::vector<WeightBlock> blocks;
  RowGather sources;            // out of the driver values
  std::vector<FloatRow> gains;  // 0 where a weight has no more sources
  RowGather opponents;  // out of the modulated weights, which a row of zeros follows: no opponent

  [[nodiscard]] std::size_t num_rows() const { return blocks.size() + 1; }  // modulated, and zeros
};

[[nodiscard]] WeightPlan MakeWeightPlan(const WeightTable& table);

}  // namespace furrow::wrinkle
