// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// The filter in double precision, value by value: One-Euro, slew limit, hold and decay.
class FilterOracle {
 public:
  FilterOracle(const Filter& filter, std::size_t num_values);

  void Update(std::span<const float> inputs, double dt);
  void Decay(double dt);
  [[nodiscard]] std::span<const float> values() const { return values_; }

 private:
  [[nodiscard]] double LimitSlew(double previous, double wanted, double dt) const;

  Filter filter_;
  std::vector<float> values_;
  std::vector<float> inputs_;
  std::vector<float> speeds_;
  double since_input_ = 0.0;
  bool started_ = false;
};

}  // namespace furrow::wrinkle
