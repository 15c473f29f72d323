// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>

#include "server/core/time.h"

namespace furrow::server {

// Lets one upload at a time through, so that all uploads together never take more memory than one
// may have. Hosts that ask in vain queue up, once each, so that no host can upload again and again
// and keep the others out. A host that does not ask again within kKept leaves the queue. Not
// thread-safe.
class UploadTurn {
 public:
  static constexpr Time kKept = std::chrono::seconds(10);
  static constexpr std::size_t kMostHosts = 64;  // that queue up

  // A turn, which ends with the last copy. It may outlive this object.
  using Turn = std::shared_ptr<void>;
  // Begins a turn of the host. Null: another upload is under way, or another host comes first.
  [[nodiscard]] Turn Begin(const std::string& host, Time now) {
    std::erase_if(queue_, [now](const Waiting& each) { return now >= each.until; });
    const auto place = std::ranges::find(queue_, host, &Waiting::host);
    const bool is_next = queue_.empty() || place == queue_.begin();
    if (!turn_.expired() || !is_next) {
      if (place != queue_.end()) place->until = now + kKept;
      if (place == queue_.end() && queue_.size() < kMostHosts) {
        queue_.push_back({host, now + kKept});
      }
      return nullptr;
    }
    Turn turn = std::make_shared<char>();
    if (place != queue_.end()) queue_.erase(place);
    turn_ = turn;
    return turn;
  }

 private:
  struct Waiting {
    std::string host;
    Time until{0};
  };
  std::weak_ptr<void> turn_;  // of the upload that is under way
  std::deque<Waiting> queue_;
};

}  // namespace furrow::server
