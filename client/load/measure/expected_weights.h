// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "client/load/schedule/plan.h"
#include "client/load/schedule/workload.h"

namespace furrow::load {

// The largest absolute difference between two rows of values; infinity if their lengths differ.
[[nodiscard]] float Distance(std::span<const float> a, std::span<const float> b);
// True if Distance() is at most `tolerance`. Stops at the first larger difference.
[[nodiscard]] bool IsNear(std::span<const float> a, std::span<const float> b, float tolerance);

// Time without gaps, microseconds, after which the state of a filter no longer depends on its
// start, unless the filter is very slow.
inline constexpr std::int64_t kFilterMemoryUs = 5'000'000;
// Time after which it no longer depends on a decay without poses, microseconds.
inline constexpr std::int64_t kForgottenUs = 2'000'000;

// The weights of a server that receives every pose of a plan. They are solved before the run, so
// that a check during the run costs one comparison.
//
// Subjects with the same start phase share their rows. Once the filter has settled, every round of
// the recording gives the same weights, so the table keeps a limited number of rounds.
class ExpectedWeights {
 public:
  // Precondition: `workload.binding` is not null. `progress` receives the completed share in [0,
  // 1]; it cancels the work by returning false, and interrupted() is then true.
  ExpectedWeights(const Workload& workload, const Plan& plan,
                  const std::function<bool(double)>& progress);

  [[nodiscard]] bool interrupted() const { return interrupted_; }
  // The weights after pose `pose` of a subject with start phase `phase`. Valid as long as the
  // table.
  [[nodiscard]] std::span<const float> Row(int phase, std::uint32_t pose) const;

  // Finds a row of the table within `tolerance` of `values`; nothing if there is none.
  struct Place {
    int phase = 0;
    std::uint32_t pose = 0;
  };
  [[nodiscard]] std::optional<Place> Find(std::span<const float> values, float tolerance) const;

 private:
  std::size_t frames_;  // per round
  std::size_t rows_;    // per phase
  std::size_t width_;   // weights per row
  bool interrupted_ = false;
  std::vector<float> values_;
};

}  // namespace furrow::load
