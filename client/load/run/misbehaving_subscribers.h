// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/status.h"
#include "client/cpp/subscriber.h"
#include "client/load/run/senders.h"

namespace furrow::load {

// Numbers of misbehaving subscribers. All of them use TCP.
struct MisbehaviorOptions {
  int slow = 0;     // read one message per second
  int stalled = 0;  // subscribe and never read
  int churn = 0;    // repeatedly subscribe, stay for half a second, and disconnect
  [[nodiscard]] int total() const { return slow + stalled + churn; }
};

// Subscribers that behave badly to put stress on the server; they are not measured. Each subscribes
// to up to 64 subjects. A subscriber connects again after the server disconnects it.
//
// Tick() does not block, except for one round trip when a subscriber connects again.
class MisbehavingSubscribers {
 public:
  // Opens the subscribers. `open(i)` opens the TCP socket of subscriber i. `subjects`: number of
  // subjects of the run, and `first` the number in the name of the first one. Errors: those of
  // `open`.
  [[nodiscard]] static Result<MisbehavingSubscribers> Open(SocketOpener open,
                                                           const MisbehaviorOptions& options,
                                                           std::uint32_t first, int subjects);

  // Performs the actions of all subscribers that are due. Call it several times per second.
  // `now_us`: microseconds of a monotonic clock.
  void Tick(std::int64_t now_us);

  // Number of times that a churning subscriber connected again.
  [[nodiscard]] std::uint64_t returns() const { return returns_; }
  // Number of observed disconnects of slow and stalled subscribers. The server may have
  // disconnected more, because a subscriber that does not read may miss the end of its connection.
  [[nodiscard]] std::uint64_t cut() const { return cut_; }

 private:
  enum class Kind { kSlow, kStalled, kChurn };
  struct Member {
    Kind kind = Kind::kStalled;
    std::int64_t due_us = 0;
    int descriptor = -1;                             // owned by `subscriber`
    std::unique_ptr<client::Subscriber> subscriber;  // null: disconnected
  };

  MisbehavingSubscribers(SocketOpener open, std::uint32_t first, int subjects)
      : open_(std::move(open)), first_(first), subjects_(subjects) {}
  [[nodiscard]] Status Connect(Member& member);
  void Churn(Member& member);
  void ReadLittle(Member& member, std::int64_t now_us);

  SocketOpener open_;
  std::uint32_t first_;
  int subjects_;
  std::vector<Member> members_;
  std::uint64_t returns_ = 0;
  std::uint64_t cut_ = 0;
};

}  // namespace furrow::load
