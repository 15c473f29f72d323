// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/subscription.h"

#include "protocol/messages/hash.h"
#include "protocol/messages/pattern.h"
#include "wrinkle/solver/driver_level.h"

namespace furrow::server {

std::span<const std::string> WeightsRequest::Names(const wrinkle::RigBinding& binding) const {
  return source == protocol::WeightSource::kDriverValues ? binding.driver_value_names()
                                                         : binding.weight_names();
}

std::vector<std::string> WeightsRequest::Bind(const wrinkle::RigBinding& binding) {
  const std::span<const std::string> all = Names(binding);
  std::vector<std::string> chosen;
  indices.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!protocol::MatchesPattern(pattern, all[i])) continue;
    indices.push_back(static_cast<std::uint32_t>(i));
    chosen.push_back(all[i]);
  }
  // Every weight frame carries this hash, so that a client notices frames of another list of names.
  names_hash = protocol::NamesHash(chosen);
  // Drivers are evaluated from the rig's first up to a level, so one number says what is needed.
  num_drivers = source == protocol::WeightSource::kDriverValues
                    ? wrinkle::DriversOfValues(binding, indices)
                    : wrinkle::DriversOfWeights(binding, indices);
  return chosen;
}

}  // namespace furrow::server
