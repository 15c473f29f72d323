// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/status.h"

namespace furrow::server {

// A file in memory by which a state with keys goes to another process. It has no name that others
// could open, and its size is sealed. The content is not, because the reader wipes it.

// Returns the descriptor, which belongs to the caller. Errors: kIo.
[[nodiscard]] Result<int> MakeStateFile(std::span<const std::uint8_t> bytes);

// Reads the file, overwrites it with zeros and closes the descriptor. So nobody reads it twice: two
// processes that go on with the same keys and counters would reveal what they send. Errors: kIo,
// also if the file is not one in memory; kLimit, it is larger than kMaxStateBytes.
[[nodiscard]] Result<std::vector<std::uint8_t>> TakeStateFile(int file);

// Overwrites the file with zeros and closes the descriptor, so that nobody reads it.
void DestroyStateFile(int file);

inline constexpr std::size_t kMaxStateBytes = std::size_t{256} << 20;

}  // namespace furrow::server
