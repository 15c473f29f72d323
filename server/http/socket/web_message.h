// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace furrow::server {

// True if a WebSocket message is exactly one message of the wire, of a known or unknown kind. Only
// such messages go to the hub. Does not read the payload.
[[nodiscard]] bool IsWebMessage(std::span<const std::uint8_t> bytes);

}  // namespace furrow::server
