// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace furrow::server {

// Whether the bytes of a WebSocket message are one whole message of the wire, known or not: what
// the hub may be bothered with. Cheap: nothing of the payload is read.
[[nodiscard]] bool IsWebMessage(std::span<const std::uint8_t> bytes);

}  // namespace furrow::server
