// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "server/cluster/node/node_address.h"
#include "server/core/time.h"

namespace furrow::server {

// Where a subject is served.
struct Place {
  enum class Kind : std::uint8_t {
    kHere,       // by this node until `until`, in `epoch`
    kElsewhere,  // by `node`, or `node` should be asked, because it has room
    kPending,    // this node is about to take it
    kNowhere,    // nobody serves it, because of `why`
  };
  Kind kind = Kind::kNowhere;
  std::uint64_t epoch = 0;
  Time until{0};
  NodeAddress node;
  std::string why;
};

// The end of a place that never ends.
inline constexpr Time kNoEnd = Time::max();

}  // namespace furrow::server
