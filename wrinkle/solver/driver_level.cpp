// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/driver_level.h"

#include <algorithm>

#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {
namespace {

// The number of drivers up to and including the driver of a value.
std::size_t DriversUpTo(const BindingData& data, int value) {
  const auto after = std::ranges::upper_bound(data.first_values, value);
  return static_cast<std::size_t>(after - data.first_values.begin());
}

// A level of detail is a prefix of the rig's drivers, so the last driver that a weight reads
// decides.
std::size_t DriversOfSources(const BindingData& data, int weight) {
  std::size_t drivers = 0;
  for (const WeightSource& source : data.weights.sources(weight)) {
    drivers = std::max(drivers, DriversUpTo(data, source.driver_value));
  }
  return drivers;
}

}  // namespace

std::size_t DriversOfWeights(const RigBinding& binding, std::span<const std::uint32_t> weights) {
  const BindingData& data = binding.data();
  std::size_t drivers = 0;
  for (const std::uint32_t index : weights) {
    const auto weight = static_cast<int>(index);
    drivers = std::max(drivers, DriversOfSources(data, weight));
    // An opponent counts with its weight before incongruence, so its own opponents do not matter.
    for (const std::uint16_t opponent : data.weights.opponents(weight)) {
      drivers = std::max(drivers, DriversOfSources(data, opponent));
    }
  }
  return drivers;
}

std::size_t DriversOfValues(const RigBinding& binding,
                            std::span<const std::uint32_t> driver_values) {
  std::size_t drivers = 0;
  for (const std::uint32_t value : driver_values) {
    drivers = std::max(drivers, DriversUpTo(binding.data(), static_cast<int>(value)));
  }
  return drivers;
}

}  // namespace furrow::wrinkle
