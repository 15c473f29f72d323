// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::load {

// Whether a datagram is a whole Pose or Weights message, whose content can be changed so that only
// the numbers tell.
[[nodiscard]] bool IsTamperable(std::span<const std::uint8_t> datagram);

// Changes one number of a pose or of weights, chosen by `share` in [0, 1); the message stays valid:
// a weight moves by a half within [0, 1], a joint turns by a third of a circle. False, and nothing
// is changed, where it is neither or has no number.
[[nodiscard]] bool Falsify(std::vector<std::uint8_t>* datagram, double share);

// Exchanges what two messages of one kind say, each keeping its envelope: stream, sequence, capture
// time. False, and nothing is changed, where they are not of one kind.
[[nodiscard]] bool SwapContents(std::vector<std::uint8_t>* a, std::vector<std::uint8_t>* b);

}  // namespace furrow::load
