// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/drivers/common/driver_explanation.h"
#include "wrinkle/drivers/hinge/hinge_fields.h"

namespace furrow::wrinkle {

inline constexpr float kLeastSine = 1e-6f;     // bones closer to parallel define no plane
inline constexpr float kFullAlongAxis = 0.5f;  // cosine to the axis above which a bend counts fully

// Up to sixteen hinge drivers, one per lane.
struct HingeBlock : BoneBlock {
  FloatRow straight[3];
  IntRow has_straight;  // -1; 0: the upper bone's direction counts as straight
  FloatRow axis[3];
  IntRow has_axis;  // -1 or 0
  FloatRow bend_scale;
};

// All hinge drivers of a binding. Private to wrinkle/. hinge_lanes-inl.h evaluates them.
class HingeDriverSet {
 public:
  struct Entry : BoneEntry {
    glm::vec3 straight{0.0f};  // unit, parent's axes; zero: the upper bone's direction
    glm::vec3 axis{0.0f};      // unit, across the straight bone, parent's axes; zero: unsigned
    float bend_scale = 0.0f;   // BendScale()

    // The direction that counts as straight in a pose, parent's axes; zero if there is none.
    [[nodiscard]] glm::vec3 Straight(std::span<const Transform> local,
                                     const JointChains& chains) const {
      return straight == glm::vec3(0.0f) ? bones.Upper(local, chains) : straight;
    }
  };

  [[nodiscard]] Status Bind(const std::string& name, const HingeDriver& driver, int first_value,
                            BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the angle from the straight direction: 0 when straight, negative for a turn against the
  // axis.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] const std::vector<HingeBlock>& blocks() const { return blocks_; }

 private:
  std::vector<Entry> entries_;
  std::vector<HingeBlock> blocks_;
};

}  // namespace furrow::wrinkle
