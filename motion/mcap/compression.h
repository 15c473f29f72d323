// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::motion::mcap {

// The bytes as one zstd frame. `level` in [1, 19].
[[nodiscard]] std::vector<std::uint8_t> CompressZstd(std::span<const std::uint8_t> bytes,
                                                     int level);

// `method`: "" (a copy), "zstd" or "lz4" (frames). Errors: kUnsupported (another method), kParse
// (not such a frame, or not exactly `size` bytes in it). Allocates as it unpacks, never much more
// than there really is, and never more than `size` for what it returns.
[[nodiscard]] Result<std::vector<std::uint8_t>> Decompress(std::string_view method,
                                                           std::span<const std::uint8_t> bytes,
                                                           std::uint64_t size);

// CRC-32 (zlib's) of `bytes`, going on from `crc` of what came before (0 at the start).
[[nodiscard]] std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace furrow::motion::mcap
