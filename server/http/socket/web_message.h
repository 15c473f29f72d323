// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace furrow::server {

// True if a WebSocket message consists of exactly one message of the Furrow protocol, of a known or
// unknown kind. Only such messages are passed to the hub. Checks the envelope, not the payload.
[[nodiscard]] bool IsWebMessage(std::span<const std::uint8_t> bytes);

}  // namespace furrow::server
