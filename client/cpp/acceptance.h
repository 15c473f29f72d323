// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "client/cpp/publisher.h"

namespace furrow::client {

// What came of an offer.
struct Acceptance {
  enum class Kind {
    kAccepted = 0,
    kRefused,       // this skeleton or subject: `reason` says why
    kError,         // the daemon complains instead of answering: `reason` is what it says
    kNobody,        // no answer within the time, or the connection was closed
    kNoConnection,  // the same, and at last nobody listened there
    kGivenUp,       // `go_on` said so
  };
  Kind kind = Kind::kNobody;
  std::string reason;
};

// Polls `publisher` until the offer of `stream` is answered: 5 seconds at the longest, and while
// `go_on()`. Who refuses connections may be just starting and is tried again. `now_us` is the clock
// that the publisher is used with, in microseconds.
[[nodiscard]] Acceptance WaitUntilAccepted(Publisher& publisher, std::uint16_t stream,
                                           const std::function<std::int64_t()>& now_us,
                                           const std::function<bool()>& go_on);

}  // namespace furrow::client
