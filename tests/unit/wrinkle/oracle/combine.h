// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/weights/weight_table.h"

namespace furrow::wrinkle {

// Maximum, clamped sum or weighted mean of gain * value, in [0, 1]. Not for kSumModulated.
[[nodiscard]] float CombineSources(Combine combine, std::span<const WeightSource> sources,
                                   std::span<const float> driver_values);

// 4.2 as printed: clamp(sum of gain * theta(value)).
[[nodiscard]] float SumModulated(const FeedModulation& modulation,
                                 std::span<const WeightSource> sources,
                                 std::span<const float> driver_values);

// All wrinkle weights of a table: combined, modulated, incongruence resolved.
[[nodiscard]] std::vector<float> WrinkleWeights(const WeightTable& table,
                                                std::span<const float> driver_values);

}  // namespace furrow::wrinkle
