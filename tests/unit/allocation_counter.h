// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::test {

// How often this program has called operator new, in any form (allocation_counter.cpp replaces it).
[[nodiscard]] std::uint64_t NumAllocations();

}  // namespace furrow::test
