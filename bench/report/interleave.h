// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace furrow::bench {

// Seconds that something took: on the wall, and of this process's processor time, all threads
// together. With a software renderer the latter is the work itself, whatever else the machine does.
struct Sample {
  double wall = 0.0;
  double cpu = 0.0;
};

// Measures one call, per one of `count` things that it does.
[[nodiscard]] Sample Measure(const std::function<void()>& call, int count);

// One thing to measure: each call gives one sample.
using Sampler = std::function<Sample()>;

// Samples of all of them, in turn: one of each, then the next of each, so that a machine that slows
// down slows all of them. A first round is thrown away: it compiles shaders and fills caches.
[[nodiscard]] std::vector<std::vector<Sample>> Interleave(std::span<const Sampler> samplers,
                                                          int repetitions);

[[nodiscard]] double MedianWall(const std::vector<Sample>& samples);
[[nodiscard]] double MedianCpu(const std::vector<Sample>& samples);

}  // namespace furrow::bench
