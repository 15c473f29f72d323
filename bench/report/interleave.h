// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace furrow::bench {

// The duration of something in seconds. With a software renderer, the processor time measures the
// rendering itself, independent of other load on the machine.
struct Sample {
  double wall = 0.0;  // elapsed time
  double cpu = 0.0;   // processor time of this process, summed over its threads
};

// Measures one call that processes `count` items. Returns the duration per item.
[[nodiscard]] Sample Measure(const std::function<void()>& call, int count);

// Something to measure: each call returns one sample.
using Sampler = std::function<Sample()>;

// Takes samples in rounds: one sample of each sampler per round, so that a change in the machine's
// speed affects all of them alike. Discards a first round, which compiles shaders and fills caches.
[[nodiscard]] std::vector<std::vector<Sample>> Interleave(std::span<const Sampler> samplers,
                                                          int repetitions);

[[nodiscard]] double MedianWall(const std::vector<Sample>& samples);
[[nodiscard]] double MedianCpu(const std::vector<Sample>& samples);

}  // namespace furrow::bench
