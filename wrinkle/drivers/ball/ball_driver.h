// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/drivers/bone_pair.h"

namespace furrow::wrinkle {

// The unit direction across `bone` and `forward` (unit, model axes) that counts as the subject's
// right: characters face +Z with +Y up, so their right is -X. A bone that lies sideways has no
// right or left; there "right" is up.
[[nodiscard]] glm::vec3 SubjectsRight(const glm::vec3& bone, const glm::vec3& forward);

// All ball-and-socket drivers of a binding (also pivot, saddle and condyloid joints, with other
// limits). Private to wrinkle/; the formula is in ball.h.
class BallDriverSet {
 public:
  // How far and whither the lower bone has bent.
  struct Bending {
    float cosine = 1.0f;   // to the straight direction
    float forward = 0.0f;  // of the projection across it
    float right = 0.0f;
  };

  struct Entry {
    int first_value = 0;
    BonePair bones;
    glm::vec3 straight{0.0f};  // unit, parent's axes; zero: the upper bone's direction
    glm::vec3 forward{0.0f};   // unit, across the rest straight direction, parent's axes
    glm::vec3 right{0.0f};     // unit, across both, towards the subject's right
    float bend_scale = 0.0f;
    BallMode mode = BallMode::kSmooth;
  };

  [[nodiscard]] Status Bind(const Driver& driver, int first_value, BindContext* context);
  void Evaluate(std::span<const Transform> local, const JointChains& chains,
                std::span<float> driver_values) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] int num_entries() const { return static_cast<int>(entries_.size()); }
  [[nodiscard]] int first_value(int entry) const { return entries_[entry].first_value; }
  [[nodiscard]] Bending Measure(int entry, std::span<const Transform> local,
                                const JointChains& chains) const;

 private:
  [[nodiscard]] static Bending MeasureEntry(const Entry& entry, std::span<const Transform> local,
                                            const JointChains& chains);
  std::vector<Entry> entries_;
};

}  // namespace furrow::wrinkle
