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

// Limits how often the hub asks one peer for the skeletons of its unknown streams: each stream at
// most once per kInterval (STANDARD.md section 6). Remembers kMaxStreams streams; further streams
// wait for the next interval.
class SkeletonRequestLimiter {
 public:
  static constexpr std::size_t kMaxStreams = 256;  // bounds the memory per peer
  static constexpr Time kInterval = std::chrono::microseconds(protocol::kNeedSkeletonMicroseconds);

  // True if the caller may send a request for the stream now. Records the request.
  [[nodiscard]] bool Allow(std::uint64_t session, std::uint16_t stream, Time now) {
    const Key key{session, stream};
    const auto known = requested_.find(key);
    if (known != requested_.end()) {
      if (now - known->second < kInterval) return false;
      known->second = now;
      return true;
    }
    if (requested_.size() >= kMaxStreams && now - swept_ >= kInterval) {
      swept_ = now;
      std::erase_if(requested_, [now](const auto& each) { return now - each.second >= kInterval; });
    }
    return requested_.size() < kMaxStreams && requested_.emplace(key, now).second;
  }

 private:
  struct Key {
    std::uint64_t session = 0;
    std::uint16_t stream = 0;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  std::map<Key, Time> requested_;  // the time of the last request
  Time swept_{-kInterval};         // when old entries were last removed
};

}  // namespace furrow::server
