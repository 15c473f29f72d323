// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace furrow::load {

// The middle of many measurements, and between what the middle half of them lies.
struct Spread {
  double median = 0.0;
  double low = 0.0;   // a quarter is below
  double high = 0.0;  // a quarter is above
};

// Of at least one value.
[[nodiscard]] Spread SpreadOf(std::vector<double> values);

// a[i] / b[i] of those i where both were measured and b is above 0: what was measured in one round
// stays together, also where a round lacks something.
[[nodiscard]] std::vector<double> Ratios(std::span<const std::optional<double>> a,
                                         std::span<const std::optional<double>> b);

// Those that were measured.
[[nodiscard]] std::vector<double> Measured(std::span<const std::optional<double>> values);

}  // namespace furrow::load
