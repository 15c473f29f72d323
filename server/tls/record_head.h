// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::server {

// The header of a TLS record: type, version and length (RFC 8446 section 5.1).
inline constexpr std::size_t kRecordHeadBytes = 5;

// The bytes of a record with its header, as far as `head`, its first bytes, can tell: that is the
// size of the header while the header is incomplete, or if it begins no valid record.
[[nodiscard]] inline std::size_t RecordBytes(std::span<const std::uint8_t> head) {
  constexpr std::size_t kMost = (1 << 14) + 256;  // RFC 8446 section 5.2
  if (head.size() < kRecordHeadBytes) return kRecordHeadBytes;
  const std::size_t length = std::size_t{head[3]} << 8 | head[4];
  const bool is_valid = head[0] >= 20 && head[0] <= 23 && head[1] == 3 && length <= kMost;
  return kRecordHeadBytes + (is_valid ? length : 0);
}

}  // namespace furrow::server
