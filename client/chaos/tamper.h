// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::chaos {

// Functions that change the contents of protocol messages. A `datagram` is the bytes of one
// datagram, or of a message that was reassembled from fragments and may be larger than a datagram.

// True if `datagram` is a whole Pose or Weights message, or a bundle that contains one. The
// functions below change such messages so that they stay valid and only their numbers are wrong.
[[nodiscard]] bool IsTamperable(std::span<const std::uint8_t> datagram);

// Changes one number of one Pose or Weights message; `share` in [0, 1) selects the number. A weight
// or blend shape moves by 0.5 within [0, 1]; a joint turns by 120 degrees. Returns false and
// changes nothing if there is no such message or no number in it.
[[nodiscard]] bool Falsify(std::vector<std::uint8_t>* datagram, double share);

// Exchanges the payloads of two messages of the same kind, one from each datagram. Each keeps its
// envelope: stream, sequence and capture time. Returns false and changes nothing if no two messages
// are of the same kind, or if a result does not fit into a datagram.
[[nodiscard]] bool SwapContents(std::vector<std::uint8_t>* a, std::vector<std::uint8_t>* b);

}  // namespace furrow::chaos
