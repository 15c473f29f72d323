// SPDX-License-Identifier: Apache-2.0
#include "bench/report/interleave.h"

#include <chrono>
#include <ctime>
#include <utility>

#include "report/statistics.h"

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
  return report::Median(std::move(values));
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

}  // namespace furrow::bench
