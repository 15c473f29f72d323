// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::load {

// Of these a `datagram` may be larger than one that is sent: a message whose fragments were put
// together.

// Whether a datagram is a whole Pose or Weights message, or a bundle with one, whose content can be
// changed so that only the numbers tell.
[[nodiscard]] bool IsTamperable(std::span<const std::uint8_t> datagram);

// Changes one number of a pose or of weights, chosen by `share` in [0, 1); the message stays valid:
// a weight or a blend shape moves by a half, a joint turns by a third of a circle. Of a bundle one
// message. False, and nothing is changed, where it is neither or has no number.
[[nodiscard]] bool Falsify(std::vector<std::uint8_t>* datagram, double share);

// Exchanges what two messages of one kind say, each keeping its envelope: stream, sequence, capture
// time. Of bundles one message each. False, and nothing is changed, where none are of one kind, or
// what comes of it does not fit a datagram.
[[nodiscard]] bool SwapContents(std::vector<std::uint8_t>* a, std::vector<std::uint8_t>* b);

}  // namespace furrow::load
