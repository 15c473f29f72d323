// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "server/core/metrics.h"
#include "server/core/time.h"

namespace furrow::server {

// What --verbose prints once a second: rates since the last line, and whatever was dropped.
class StatusLine {
 public:
  explicit StatusLine(const Metrics* metrics) : metrics_(metrics) {}

  // "2 subjects, 3 subscriptions, 60 poses/s, 180 weights/s, 30 pictures/s; dropped: 4 late poses"
  [[nodiscard]] std::string Next(std::size_t subjects, std::size_t subscriptions, Time now);

 private:
  std::uint64_t Since(Counter counter);

  const Metrics* metrics_;
  std::array<std::uint64_t, static_cast<std::size_t>(Counter::kCount)> last_{};
  Time last_time_{0};
};

}  // namespace furrow::server
