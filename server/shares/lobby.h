// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <iterator>
#include <list>
#include <memory>
#include <string>
#include <utility>

#include "server/core/time.h"
#include "server/shares/token_bucket.h"

namespace furrow::server {

// Newcomers that wait until a connection without use has given way to them. Each host has a queue,
// so that no newcomer takes the place that was made for an earlier one. Each newcomer costs a look
// at all connections, so their number and their rate are limited; further newcomers are refused at
// once. Not thread-safe.
class Lobby {
 public:
  static constexpr Time kPatience = std::chrono::seconds(2);  // then a newcomer is refused
  static constexpr auto kPoll = std::chrono::milliseconds(5);
  // After this long, another connection must give way.
  static constexpr Time kAgain = std::chrono::milliseconds(100);
  static constexpr int kPlaces = 32;
  static constexpr double kPerSecond = 200.0;
  // Of one host, where strangers may hold little memory. A stay takes about 2 kB in all.
  static constexpr int kFewPlaces = 3;

  // `most_of_host`: newcomers of one host.
  explicit Lobby(int most_of_host = kPlaces) : most_of_host_(most_of_host) {}

  // A newcomer's stay, which ends with the last copy. It may outlive the lobby.
  using Stay = std::shared_ptr<void>;
  // The newcomer joins the queue of its host. Null: refuse it.
  [[nodiscard]] Stay Enter(std::string host, Time now) {
    if (queue_->size() >= kPlaces || std::ranges::count(*queue_, host) >= most_of_host_ ||
        !rate_.Take(now)) {
      return nullptr;
    }
    queue_->push_back(std::move(host));
    const auto place = std::prev(queue_->end());
    return {&*place, [queue = queue_, place](void*) { queue->erase(place); }};
  }

  // A newcomer of the host waits.
  [[nodiscard]] bool HasQueue(const std::string& host) const {
    return std::ranges::find(*queue_, host) != queue_->end();
  }
  // No newcomer of the host entered before this one, which stays.
  [[nodiscard]] bool IsFirst(const std::string& host, const Stay& stay) const {
    return &*std::ranges::find(*queue_, host) == stay.get();
  }

 private:
  const int most_of_host_;
  TokenBucket rate_{kPerSecond, kPlaces};
  std::shared_ptr<std::list<std::string>> queue_ = std::make_shared<std::list<std::string>>();
};

}  // namespace furrow::server
