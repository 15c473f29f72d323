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

  // Sets the joints and skin weights of `vertex`.
  void CopyTo(character::Vertex* vertex) const;
};

// Adds up the weights of any number of joints and selects the strongest four.
class InfluenceSum {
 public:
  // Ignores weights that are not positive.
  void Add(std::uint16_t joint, float weight);
  // Adds all joints of `influences`, with their weights multiplied by `share`.
  void Add(const Influences& influences, float share);

  [[nodiscard]] std::size_t num_joints() const { return sums_.size(); }
  // The four strongest joints, with weights scaled to sum to 1. Among equal weights, the lower
  // joint index wins. Without any weight: joint 0, the root, with weight 1.
  [[nodiscard]] Influences Strongest() const;

 private:
  struct JointWeight {
    std::uint16_t joint;
    float weight;
  };
  std::vector<JointWeight> sums_;  // one entry per joint
};

}  // namespace furrow::authoring
