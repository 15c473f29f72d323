// SPDX-License-Identifier: Apache-2.0
#include "authoring/skinning/influences.h"

#include <algorithm>
#include <iterator>

namespace furrow::authoring {

void Influences::CopyTo(character::Vertex* vertex) const {
  std::copy(std::begin(joints), std::end(joints), vertex->joints);
  std::copy(std::begin(weights), std::end(weights), vertex->skin_weights);
}

void InfluenceSum::Add(std::uint16_t joint, float weight) {
  if (!(weight > 0.0f)) return;
  const auto it = std::find_if(sums_.begin(), sums_.end(),
                               [joint](const JointWeight& sum) { return sum.joint == joint; });
  if (it == sums_.end()) {
    sums_.push_back({joint, weight});
  } else {
    it->weight += weight;
  }
}

void InfluenceSum::Add(const Influences& influences, float share) {
  for (std::size_t k = 0; k < 4; ++k) Add(influences.joints[k], share * influences.weights[k]);
}

Influences InfluenceSum::Strongest() const {
  std::vector<JointWeight> order = sums_;
  // Equal weights are ordered by joint, so the choice of four does not depend on the order of
  // Add().
  std::sort(order.begin(), order.end(), [](const JointWeight& a, const JointWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
  });
  order.resize(std::min<std::size_t>(order.size(), 4));
  float sum = 0.0f;
  for (const JointWeight& entry : order) sum += entry.weight;
  Influences strongest;
  for (std::size_t k = 0; k < order.size(); ++k) {
    strongest.joints[k] = order[k].joint;
    strongest.weights[k] = order[k].weight / sum;
  }
  return strongest;
}

}  // namespace furrow::authoring
