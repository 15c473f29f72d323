// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "client/cpp/publisher.h"

namespace furrow::client {

// The daemon's answer to an offer.
struct Acceptance {
  enum class Kind {
    kAccepted = 0,
    kRefused,       // rejected by the daemon, or the offer cannot be sent; see `reason`
    kError,         // the daemon replied with an error; see `reason`
    kNoAnswer,      // timeout, or the connection was closed
    kNoConnection,  // as kNoAnswer, and the last attempt found the port closed
    kCancelled,     // `keep_going` returned false
  };
  Kind kind = Kind::kNoAnswer;
  std::string reason;  // for people; empty unless kRefused or kError
};

// Polls `publisher` until the daemon answers the offer of `stream`, for 5 seconds at most.
//
// If the port is closed, polls on, because the daemon may be starting. `now_us` returns the time on
// the clock that the publisher is used with, microseconds. `keep_going` is called about 50 times
// per second; returning false cancels the wait.
[[nodiscard]] Acceptance WaitUntilAccepted(Publisher& publisher, std::uint16_t stream,
                                           const std::function<std::int64_t()>& now_us,
                                           const std::function<bool()>& keep_going);

}  // namespace furrow::client
