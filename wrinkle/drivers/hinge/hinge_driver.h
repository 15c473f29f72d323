// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/drivers/bone_pair.h"

namespace furrow::wrinkle {

// All hinge drivers of a binding. Private to wrinkle/; the formula is in hinge.h.
class HingeDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    BonePair bones;
    glm::vec3 axis{0.0f};  // unit, across the rest upper bone, parent's axes; zero: unsigned
    float bend_scale = 0.0f;
  };

  [[nodiscard]] Status Bind(const Driver& driver, int first_value, BindContext* context);
  void Evaluate(std::span<const Transform> local, const JointChains& chains,
                std::span<float> driver_values) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] int num_entries() const { return static_cast<int>(entries_.size()); }
  [[nodiscard]] int first_value(int entry) const { return entries_[entry].first_value; }
  // Angle between the bones in degrees, 0 when straight; negative where it turns against the axis.
  [[nodiscard]] float AngleDegrees(int entry, std::span<const Transform> local,
                                   const JointChains& chains) const;

 private:
  std::vector<Entry> entries_;
};

}  // namespace furrow::wrinkle
