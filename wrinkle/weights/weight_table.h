// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/weights/modulation_curve.h"

namespace furrow::wrinkle {

// One driver value that feeds a weight.
struct WeightSource {
  int driver_value = 0;  // index into the driver values
  float gain = 1.0f;
};

// How driver values become wrinkle weights: one entry per weight, over flat pools. weight_plan.h
// lays it out for the kernel. Private to wrinkle/.
class WeightTable {
 public:
  // `value_index`: the index of each "<driver>.<value>". Errors: kNotFound for an unknown name,
  // kInvalidArgument for a region that is its own neighbour.
  [[nodiscard]] Status Bind(const Rig& rig,
                            const std::unordered_map<std::string, int>& value_index);

  [[nodiscard]] std::span<const std::string> names() const { return names_; }
  [[nodiscard]] std::span<const WeightSource> sources(int weight) const {
    const Entry& entry = entries_[weight];
    return std::span(sources_).subspan(entry.first_source, entry.num_sources);
  }
  // The weights of neighbouring regions on maps that oppose this weight's map.
  [[nodiscard]] std::span<const std::uint16_t> opponents(int weight) const {
    const Entry& entry = entries_[weight];
    return std::span(opponents_).subspan(entry.first_opponent, entry.num_opponents);
  }

  [[nodiscard]] Combine combine(int weight) const { return entries_[weight].combine; }
  [[nodiscard]] FeedModulation modulation(int weight) const {
    const Entry& entry = entries_[weight];
    return {.modulation = entry.modulation, .curve = entry.curve};
  }

 private:
  struct Entry {
    std::uint32_t first_source = 0;
    std::uint32_t num_sources = 0;
    std::uint32_t first_opponent = 0;
    std::uint32_t num_opponents = 0;
    Combine combine = Combine::kMax;
    Modulation modulation = Modulation::kCosine;
    std::vector<CurvePoint> curve;
  };
  [[nodiscard]] Status BindFeed(const Rig& rig, const Region& region, const Feed& feed,
                                const std::unordered_map<std::string, int>& value_index);
  void BindOpponents(const Rig& rig);

  std::vector<std::string> names_;
  std::vector<Entry> entries_;
  std::vector<WeightSource> sources_;
  std::vector<std::uint16_t> opponents_;
};

}  // namespace furrow::wrinkle
