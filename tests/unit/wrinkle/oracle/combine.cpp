// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/combine.h"

#include <algorithm>

#include "base/scalar.h"
#include "tests/unit/wrinkle/oracle/incongruence.h"
#include "tests/unit/wrinkle/oracle/modulation.h"

namespace furrow::wrinkle {

float CombineSources(Combine combine, std::span<const WeightSource> sources,
                     std::span<const float> driver_values) {
  float largest = 0.0f;
  float sum = 0.0f;
  float gains = 0.0f;
  for (const WeightSource& source : sources) {
    const float term = source.gain * driver_values[source.driver_value];
    largest = std::max(largest, term);
    sum += term;
    gains += source.gain;
  }
  switch (combine) {
    case Combine::kMax: return Saturate(largest);
    case Combine::kSum: return Saturate(sum);
    case Combine::kMean: return gains > 0.0f ? Saturate(sum / gains) : 0.0f;
    case Combine::kSumModulated: break;
  }
  return 0.0f;
}

float SumModulated(const FeedModulation& modulation, std::span<const WeightSource> sources,
                   std::span<const float> driver_values) {
  float sum = 0.0f;
  for (const WeightSource& source : sources) {
    sum += source.gain * Modulate(modulation, driver_values[source.driver_value]);
  }
  return Saturate(sum);
}

std::vector<float> WrinkleWeights(const WeightTable& table, std::span<const float> driver_values) {
  const int count = static_cast<int>(table.names().size());
  std::vector<float> modulated;
  for (int i = 0; i < count; ++i) {
    const Combine combine = table.combine(i);
    modulated.push_back(combine == Combine::kSumModulated
                            ? SumModulated(table.modulation(i), table.sources(i), driver_values)
                            : Modulate(table.modulation(i),
                                       CombineSources(combine, table.sources(i), driver_values)));
  }
  std::vector<float> weights = modulated;
  for (int i = 0; i < count; ++i) {
    for (const std::uint16_t opponent : table.opponents(i)) {
      weights[i] *= CongruenceFactor(modulated[i], modulated[opponent]);
    }
  }
  return weights;
}

}  // namespace furrow::wrinkle
