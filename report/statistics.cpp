// SPDX-License-Identifier: Apache-2.0
#include "report/statistics.h"

#include <algorithm>

namespace furrow::report {

double Median(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t middle = samples.size() / 2;
  return samples.size() % 2 == 1 ? samples[middle] : 0.5 * (samples[middle - 1] + samples[middle]);
}

}  // namespace furrow::report
