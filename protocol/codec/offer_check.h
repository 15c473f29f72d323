// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace furrow::protocol {

// Checks an encoded SkeletonOffer before it is sent: `offer` is the whole message that Encode()
// wrote. Returns a problem for people to read, or an empty string if a daemon would accept the
// offer. Publishers call this first, because a daemon drops an offer that it cannot decode and may
// be unable to reply.
[[nodiscard]] std::string FindOfferProblem(std::span<const std::uint8_t> offer);

}  // namespace furrow::protocol
