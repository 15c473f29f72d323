// SPDX-License-Identifier: Apache-2.0
#include "bench/report/interleave.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace furrow::bench {
namespace {

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double MedianOf(const std::vector<Sample>& samples, double Sample::*member) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(sample.*member);
  return Median(values);
}

}  // namespace

Sample Measure(const std::function<void()>& call, int count) {
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = CpuSeconds();
  call();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - wall;
  return {taken.count() / count, (CpuSeconds() - cpu) / count};
}

double MedianWall(const std::vector<Sample>& samples) { return MedianOf(samples, &Sample::wall); }
double MedianCpu(const std::vector<Sample>& samples) { return MedianOf(samples, &Sample::cpu); }

std::vector<std::vector<Sample>> Interleave(std::span<const Sampler> samplers, int repetitions) {
  std::vector<std::vector<Sample>> samples(samplers.size());
  for (int round = 0; round <= repetitions; ++round) {
    for (std::size_t i = 0; i < samplers.size(); ++i) {
      const Sample sample = samplers[i]();
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
