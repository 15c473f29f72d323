// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "client/load/schedule/performance.h"
#include "client/load/schedule/plan.h"

namespace furrow::load {

// The largest difference of two rows of values; infinity where they are not of one length.
[[nodiscard]] float Distance(std::span<const float> a, std::span<const float> b);
// Whether it is at most `tolerance`; says no at the first value that is beyond.
[[nodiscard]] bool IsNear(std::span<const float> a, std::span<const float> b, float tolerance);

// After so long without a gap a filter has forgotten how it began, unless it is a very slow one.
inline constexpr std::int64_t kFilterMemoryUs = 5'000'000;

// The weights that a server sends which uses every pose of a plan: solved before the run, so that
// checking costs a comparison while it lasts.
//
// Subjects that start at the same phase share a row a pose. After the filter has settled, rounds of
// the recording repeat: only so many are kept, however long the run.
class Expected {
 public:
  // `performance.binding` not null. `progress` is told the share done, and ends the work by false
  // (interrupted() then).
  Expected(const Performance& performance, const Plan& plan,
           const std::function<bool(double)>& progress);

  [[nodiscard]] bool interrupted() const { return interrupted_; }
  [[nodiscard]] std::span<const float> Row(int phase, std::uint32_t pose) const;

  // Where in the whole table there is a row within `tolerance` of these values.
  struct Place {
    int phase = 0;
    std::uint32_t pose = 0;
  };
  [[nodiscard]] std::optional<Place> Find(std::span<const float> values, float tolerance) const;

 private:
  std::size_t frames_;  // of a round
  std::size_t rows_;    // of a phase
  std::size_t width_;
  bool interrupted_ = false;
  std::vector<float> values_;
};

}  // namespace furrow::load
