// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/status.h"
#include "client/cpp/subscriber.h"
#include "client/load/net/socket.h"
#include "client/load/schedule/senders.h"

namespace furrow::load {

// How many subscribers misbehave, all over TCP.
struct BurdenOptions {
  int slow = 0;     // take one message a second
  int stalled = 0;  // subscribe and never read again
  int churn = 0;    // subscribe, read for half a second, leave, and come back
  [[nodiscard]] int total() const { return slow + stalled + churn; }
};

// Subscribers that are not measured but make it hard for the server. Each asks for up to 64
// subjects. None of them is waited for, but for the connecting of those that come back: a round
// trip. Those that the server cuts off are opened again.
class Burdens {
 public:
  // Errors: those of `open`.
  [[nodiscard]] static Result<Burdens> Open(OpenSocket open, const BurdenOptions& options,
                                            int subjects);

  // Does what is due; call it often.
  void Tick(std::int64_t now_us);

  // How often a churning subscriber came back.
  [[nodiscard]] std::uint64_t returns() const { return returns_; }
  // How often the server was seen to cut off a slow or stalled one: it may have done so more often,
  // since its last word does not reach who reads nothing.
  [[nodiscard]] std::uint64_t cut() const { return cut_; }

 private:
  enum class Kind { kSlow, kStalled, kChurn };
  struct Burden {
    Kind kind = Kind::kStalled;
    std::int64_t due_us = 0;
    int descriptor = -1;  // the subscriber's
    std::unique_ptr<client::Subscriber> subscriber;
  };

  Burdens(OpenSocket open, int subjects) : open_(std::move(open)), subjects_(subjects) {}
  [[nodiscard]] Status Begin(Burden& burden);
  void Churn(Burden& burden);
  void Weigh(Burden& burden, std::int64_t now_us);

  OpenSocket open_;
  int subjects_;
  std::vector<Burden> burdens_;
  std::uint64_t returns_ = 0;
  std::uint64_t cut_ = 0;
};

}  // namespace furrow::load
