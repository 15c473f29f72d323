// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/quartiles.h"

#include <algorithm>
#include <cmath>

namespace furrow::load {

Quartiles QuartilesOf(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    // Linear interpolation between the two nearest ranks (Hyndman and Fan 1996, type 7).
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
  };
  return {at(0.5), at(0.25), at(0.75)};
}

std::vector<double> Ratios(std::span<const std::optional<double>> a,
                           std::span<const std::optional<double>> b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    // Ratios of paired runs, and their median later: a slow moment of the machine hits both runs of
    // a pair, while the ratio of two medians would keep it.
    if (a[i] && b[i] && *b[i] > 0.0) ratios.push_back(*a[i] / *b[i]);
  }
  return ratios;
}

std::vector<double> Measured(std::span<const std::optional<double>> values) {
  std::vector<double> measured;
  for (const std::optional<double>& value : values) {
    if (value) measured.push_back(*value);
  }
  return measured;
}

}  // namespace furrow::load
