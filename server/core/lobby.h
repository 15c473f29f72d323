// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "server/core/time.h"
#include "server/core/token_bucket.h"

namespace furrow::server {

// Bounds the newcomers that wait until a connection without use has given way to them. Each of them
// costs a look at all connections, so their number and their rate are limited; further newcomers
// are refused at once. Not thread-safe.
class Lobby {
 public:
  static constexpr Time kPatience = std::chrono::seconds(2);  // then a newcomer is refused
  static constexpr auto kPoll = std::chrono::milliseconds(5);
  // After this long, somebody else has taken the place, and another connection must give way.
  static constexpr Time kAgain = std::chrono::milliseconds(100);
  static constexpr int kPlaces = 32;
  static constexpr double kPerSecond = 200.0;

  // A newcomer's stay, which ends with the last copy. It may outlive the lobby.
  using Stay = std::shared_ptr<void>;
  // Null: refuse the newcomer.
  [[nodiscard]] Stay Enter(Time now) {
    if (*waiting_ >= kPlaces || !rate_.Take(now)) return nullptr;
    ++*waiting_;
    return {waiting_.get(), [waiting = waiting_](void*) { --*waiting; }};
  }

 private:
  TokenBucket rate_{kPerSecond, kPlaces};
  std::shared_ptr<int> waiting_ = std::make_shared<int>(0);
};

}  // namespace furrow::server
