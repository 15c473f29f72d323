// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace furrow::protocol {

// Checks an encoded SkeletonOffer before it is sent. Returns a human-readable problem, or an empty
// string if the wire can carry the offer. Publishers call this first, because a daemon drops an
// offer that it cannot read and may be unable to reply.
[[nodiscard]] std::string FindOfferProblem(std::span<const std::uint8_t> offer);

}  // namespace furrow::protocol
