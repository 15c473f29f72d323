// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::motion::mcap {

// Compresses bytes to one zstd frame. `level` is in [1, 19]. None: zstd has no memory for it.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> CompressZstd(
    std::span<const std::uint8_t> bytes, int level);

// Decompresses bytes. `method` is "" (a copy), "zstd" or "lz4" (frames). `size` is the stated size
// of the result; memory grows with the actual data, so a false size costs little.
//
// Errors: kUnsupported (another method), kParse (damaged data, or not exactly `size` bytes),
// kInternal (out of memory).
[[nodiscard]] Result<std::vector<std::uint8_t>> Decompress(std::string_view method,
                                                           std::span<const std::uint8_t> bytes,
                                                           std::uint64_t size);

// CRC-32 (as in zlib) of `bytes`. Pass the result for the preceding bytes as `crc` to continue.
[[nodiscard]] std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace furrow::motion::mcap
