// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/acceptance.h"

#include <chrono>
#include <thread>

namespace furrow::client {

using Kind = Acceptance::Kind;

Acceptance WaitUntilAccepted(Publisher& publisher, std::uint16_t stream,
                             const std::function<std::int64_t()>& now_us,
                             const std::function<bool()>& keep_going) {
  constexpr std::int64_t kTimeoutUs = 5'000'000;
  constexpr std::chrono::milliseconds kStep(20);  // between two calls of `keep_going`
  const std::int64_t deadline = now_us() + kTimeoutUs;
  bool refused = false;
  while (keep_going()) {
    const IoStatus status = publisher.Poll(now_us(), kStep);
    // The system reports a closed port only after a send. Between two offers Poll() times out,
    // which does not cancel the last report.
    if (status != IoStatus::kTimeout) refused = status == IoStatus::kNoConnection;
    if (publisher.accepted(stream)) return {Kind::kAccepted, {}};
    if (publisher.needs_token()) return {Kind::kError, publisher.last_error()};
    if (!publisher.rejection(stream).empty()) return {Kind::kRefused, publisher.rejection(stream)};
    if (status == IoStatus::kClosed || status == IoStatus::kMalformed || now_us() >= deadline) {
      if (!publisher.last_error().empty()) return {Kind::kError, publisher.last_error()};
      return {refused ? Kind::kNoConnection : Kind::kNoAnswer, {}};
    }
    // A refusal is reported at once, so the wait happens here.
    if (status == IoStatus::kNoConnection) std::this_thread::sleep_for(kStep);
  }
  return {Kind::kCancelled, {}};
}

}  // namespace furrow::client
