// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace furrow::authoring {

bool ParallelFor(std::size_t count, int threads,
                 const std::function<void(std::size_t, std::size_t)>& work,
                 const std::function<bool(float)>& progress, std::size_t range_length) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  // Threads take ranges from a common counter, so a slow range does not hold up the others.
  const auto run_one_range = [&] {
    const std::size_t first = next.fetch_add(range_length);
    if (first >= count || stopped) return false;
    work(first, std::min(first + range_length, count));
    return true;
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) {
    others.emplace_back([&] {
      while (run_one_range()) {
      }
    });
  }
  while (run_one_range()) {
    const float done = static_cast<float>(std::min(next.load(), count)) / static_cast<float>(count);
    if (progress && !progress(done)) stopped = true;
  }
  others.clear();  // joins the threads
  if (!stopped && progress && !progress(1.0f)) stopped = true;
  return !stopped;
}

}  // namespace furrow::authoring
