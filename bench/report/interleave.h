// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace furrow::bench {

// One thing to measure: each call gives one sample.
using Sampler = std::function<double()>;

// Samples of all of them, in turn: one of each, then the next of each, so that a machine that slows
// down slows all of them. A first round is thrown away: it compiles shaders and fills caches.
[[nodiscard]] std::vector<std::vector<double>> Interleave(std::span<const Sampler> samplers,
                                                          int repetitions);

// Of at least one sample; of an even number, the mean of the middle two.
[[nodiscard]] double Median(std::vector<double> samples);

}  // namespace furrow::bench
