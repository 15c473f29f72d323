// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace furrow::authoring {

// Calls work(first, last) for consecutive ranges that together cover [0, count), on `threads`
// threads including the calling one. Threads take ranges in any order, so `work` must write only
// to entries of the range that it was given. `progress` (optional) is called on the calling thread
// with the completed fraction, [0, 1]; returning false stops the loop. Returns false if stopped.
// `range_length`: of a range, > 0; 1 for entries that take long.
[[nodiscard]] bool ParallelFor(std::size_t count, int threads,
                               const std::function<void(std::size_t, std::size_t)>& work,
                               const std::function<bool(float)>& progress,
                               std::size_t range_length = 8192);

}  // namespace furrow::authoring
