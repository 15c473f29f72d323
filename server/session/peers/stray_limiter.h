// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>

#include "protocol/messages/limits.h"
#include "server/core/time.h"

namespace furrow::server {

// How often the streams of one peer are asked for their skeletons: each at most once an interval
// (STANDARD.md section 6). Remembers kMaxStreams; where more than that ask within one interval, the
// rest waits for the next.
class StrayLimiter {
 public:
  static constexpr std::size_t kMaxStreams = 256;
  static constexpr Time kInterval = std::chrono::microseconds(protocol::kNeedSkeletonMicroseconds);

  // True when the stream may be answered now; it then has been.
  [[nodiscard]] bool Take(std::uint64_t session, std::uint16_t stream, Time now) {
    const Key key{session, stream};
    const auto known = answered_.find(key);
    if (known != answered_.end()) {
      if (now - known->second < kInterval) return false;
      known->second = now;
      return true;
    }
    if (answered_.size() >= kMaxStreams && now - swept_ >= kInterval) {
      swept_ = now;
      std::erase_if(answered_, [now](const auto& each) { return now - each.second >= kInterval; });
    }
    return answered_.size() < kMaxStreams && answered_.emplace(key, now).second;
  }

 private:
  struct Key {
    std::uint64_t session = 0;
    std::uint16_t stream = 0;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  std::map<Key, Time> answered_;
  Time swept_{-kInterval};
};

}  // namespace furrow::server
