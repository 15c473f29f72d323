// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace furrow::protocol {

// Why the wire cannot carry an encoded SkeletonOffer, for people; empty where it can. A publisher
// asks before it sends: a daemon that cannot read an offer may only drop it.
[[nodiscard]] std::string WhyUnsendable(std::span<const std::uint8_t> offer);

}  // namespace furrow::protocol
