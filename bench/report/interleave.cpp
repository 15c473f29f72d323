// SPDX-License-Identifier: Apache-2.0
#include "bench/report/interleave.h"

#include <algorithm>

namespace furrow::bench {

std::vector<std::vector<double>> Interleave(std::span<const Sampler> samplers, int repetitions) {
  std::vector<std::vector<double>> samples(samplers.size());
  for (int round = 0; round <= repetitions; ++round) {
    for (std::size_t i = 0; i < samplers.size(); ++i) {
      const double sample = samplers[i]();
      if (round > 0) samples[i].push_back(sample);
    }
  }
  return samples;
}

double Median(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t middle = samples.size() / 2;
  return samples.size() % 2 == 1 ? samples[middle] : 0.5 * (samples[middle - 1] + samples[middle]);
}

}  // namespace furrow::bench
