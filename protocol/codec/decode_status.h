// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace furrow::protocol {

// The reason for which a decoder rejects bytes. Used for counters. The values are in the order of
// the checks, cheapest first (STANDARD.md section 11).
enum class DecodeStatus : std::uint8_t {
  kOk = 0,
  kTooShort,
  kBadMagic,
  kBadVersion,
  kBadFlags,  // an undefined flag, or a fragment or bundle instead of a whole message
  kBadSession,
  kBadLength,    // the payload size differs from the byte count or exceeds the transport's limit
  kUnknownKind,  // an unknown file identifier; the peer is probably newer: ignore the message
  kWrongKind,    // Decode() was called with the struct of another message
  kUnverified,   // the FlatBuffers verifier rejected the payload
  kMissingField,
  kBadCount,   // contradictory counts, or indices out of order
  kLimit,      // more joints, names or characters than limits.h allows
  kNonFinite,  // NaN or infinity
  kNotUnit,    // a quaternion whose length differs from 1 by more than 1e-3
  kBadValue,   // an unknown enum value, or a number outside its range
  kBadText,    // text that is not UTF-8, or a name that is empty or duplicated
  kBadHash,    // a skeleton offer or name list that does not match its hash
};
inline constexpr int kNumDecodeStatuses = static_cast<int>(DecodeStatus::kBadHash) + 1;

// Stable lowercase name ("bad_magic"), for counters and logs.
[[nodiscard]] std::string_view DecodeStatusName(DecodeStatus status);

}  // namespace furrow::protocol

// Returns from the enclosing function unless `expression` is kOk.
#define FURROW_CHECK_DECODE(expression)                                  \
  do {                                                                   \
    const ::furrow::protocol::DecodeStatus check_status_ = (expression); \
    if (check_status_ != ::furrow::protocol::DecodeStatus::kOk) {        \
      return check_status_;                                              \
    }                                                                    \
  } while (false)
