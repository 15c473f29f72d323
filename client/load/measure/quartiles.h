// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace furrow::load {

// Median and quartiles of a set of samples.
struct Quartiles {
  double median = 0.0;
  double low = 0.0;   // first quartile
  double high = 0.0;  // third quartile
};

// Returns the quartiles of `values`, interpolated linearly. Precondition: at least one value.
[[nodiscard]] Quartiles QuartilesOf(std::vector<double> values);

// Returns the ratios a[i] / b[i] of all rounds i in which both were measured and b[i] is positive.
[[nodiscard]] std::vector<double> Ratios(std::span<const std::optional<double>> a,
                                         std::span<const std::optional<double>> b);

// Returns the values of all rounds that have one.
[[nodiscard]] std::vector<double> Measured(std::span<const std::optional<double>> values);

}  // namespace furrow::load
