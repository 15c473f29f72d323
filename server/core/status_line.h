// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "server/core/metrics.h"
#include "server/core/time.h"

namespace furrow::server {

// Composes the line that --verbose prints every second: rates since the last line, and drop counts.
class StatusLine {
 public:
  // `metrics`: not null; must outlive this object.
  explicit StatusLine(const Metrics* metrics) : metrics_(metrics) {}

  // Returns the next line, for example "2 subjects, 3 subscriptions, 60 poses/s, 180 weights/s, 30
  // pictures/s; dropped: 4 late poses". Counters that did not change are left out of the second
  // part.
  [[nodiscard]] std::string Next(std::size_t subjects, std::size_t subscriptions, Time now);

 private:
  std::uint64_t CountSinceLastLine(Counter counter);

  const Metrics* metrics_;
  std::array<std::uint64_t, static_cast<std::size_t>(Counter::kCount)> last_{};
  Time last_time_{0};
};

}  // namespace furrow::server
