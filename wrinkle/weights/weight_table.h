// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// One driver value that feeds a weight.
struct WeightSource {
  int driver_value = 0;  // index into the driver values
  float gain = 1.0f;
};

// max, clamped sum or weighted mean of gain * value; in [0, 1].
[[nodiscard]] float CombineSources(Combine combine, std::span<const WeightSource> sources,
                                   std::span<const float> driver_values);

// How driver values become wrinkle weights: one entry a
// weight, over flat pools. Private to wrinkle/.
class WeightTable {
 public:
  // `value_index`: "<driver>.<value>" to its index. Errors:
  // kNotFound for a name that leads nowhere.
  [[nodiscard]] Status Bind(const Rig& rig,
                            const std::unordered_map<std::string, int>& value_index);

  [[nodiscard]] std::span<const std::string> names() const { return names_; }
  [[nodiscard]] std::span<const WeightSource> sources(int weight) const {
    const Entry& entry = entries_[weight];
    return std::span(sources_).subspan(entry.first_source, entry.num_sources);
  }
  // Weights of neighbouring regions on maps that oppose this one's.
  [[nodiscard]] std::span<const std::uint16_t> opponents(int weight) const {
    const Entry& entry = entries_[weight];
    return std::span(opponents_).subspan(entry.first_opponent, entry.num_opponents);
  }

  [[nodiscard]] Combine combine(int weight) const { return entries_[weight].combine; }
  [[nodiscard]] Modulation modulation(int weight) const { return entries_[weight].modulation; }

  [[nodiscard]] float Combined(int weight, std::span<const float> driver_values) const;
  [[nodiscard]] float Modulated(int weight, std::span<const float> driver_values) const;
  // What remains of a weight beside all its opponents, as a factor; `modulated` holds all weights.
  [[nodiscard]] float Congruence(int weight, std::span<const float> modulated) const;

 private:
  struct Entry {
    std::uint32_t first_source = 0;
    std::uint32_t num_sources = 0;
    std::uint32_t first_opponent = 0;
    std::uint32_t num_opponents = 0;
    Combine combine = Combine::kMax;
    Modulation modulation = Modulation::kCosine;
  };
  [[nodiscard]] Status BindFeed(const Region& region, const Feed& feed,
                                const std::unordered_map<std::string, int>& value_index);
  void BindOpponents(const Rig& rig);

  std::vector<std::string> names_;
  std::vector<Entry> entries_;
  std::vector<WeightSource> sources_;
  std::vector<std::uint16_t> opponents_;
};

}  // namespace furrow::wrinkle
