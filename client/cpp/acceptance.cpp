// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/acceptance.h"

#include <chrono>
#include <thread>

namespace furrow::client {

using Kind = Acceptance::Kind;

Acceptance WaitUntilAccepted(Publisher& publisher, std::uint16_t stream,
                             const std::function<std::int64_t()>& now_us,
                             const std::function<bool()>& go_on) {
  constexpr std::int64_t kLongestUs = 5'000'000;
  constexpr std::chrono::milliseconds kStep(20);  // until the next look at `go_on`
  const std::int64_t deadline = now_us() + kLongestUs;
  bool refused = false;  // rather than silent
  while (go_on()) {
    const IoStatus status = publisher.Poll(now_us(), kStep);
    // A refusal answers what was sent: between two offers there is silence.
    if (status != IoStatus::kTimeout) refused = status == IoStatus::kNoConnection;
    if (publisher.accepted(stream)) return {Kind::kAccepted, {}};
    if (!publisher.rejection(stream).empty()) return {Kind::kRefused, publisher.rejection(stream)};
    if (status == IoStatus::kClosed || status == IoStatus::kMalformed || now_us() >= deadline) {
      if (!publisher.last_error().empty()) return {Kind::kError, publisher.last_error()};
      return {refused ? Kind::kNoConnection : Kind::kNobody, {}};
    }
    // It comes at once.
    if (status == IoStatus::kNoConnection) std::this_thread::sleep_for(kStep);
  }
  return {Kind::kGivenUp, {}};
}

}  // namespace furrow::client
