// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "character/character.h"

namespace furrow::authoring {

// The joints that move one vertex: at most four, the strongest first. The weights sum to 1.
struct Influences {
  std::uint16_t joints[4] = {0, 0, 0, 0};
  float weights[4] = {1.0f, 0.0f, 0.0f, 0.0f};

  void CopyTo(character::Vertex* vertex) const;
};

// Adds up weights of any number of joints and keeps the strongest four.
class InfluenceSum {
 public:
  // Ignores weights that are not positive.
  void Add(std::uint16_t joint, float weight);
  // Adds all joints of `influences`, their weights scaled by `share`.
  void Add(const Influences& influences, float share);

  [[nodiscard]] std::size_t num_joints() const { return sums_.size(); }
  // The four strongest joints, normalised. Equal weights: the lower joint first. Without any
  // weight: joint 0, the root.
  [[nodiscard]] Influences Strongest() const;

 private:
  struct JointWeight {
    std::uint16_t joint;
    float weight;
  };
  std::vector<JointWeight> sums_;  // one entry per joint
};

}  // namespace furrow::authoring
