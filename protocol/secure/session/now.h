// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::protocol::secure {

// The time as an argument; nothing in this folder reads a clock.
struct Now {
  std::int64_t us = 0;       // on a clock that never runs backwards, at least 0, any epoch
  std::uint64_t unix_s = 0;  // Unix time in seconds, for the expiry of tokens
};

}  // namespace furrow::protocol::secure
