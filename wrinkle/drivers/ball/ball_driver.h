// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "wrinkle/drivers/ball/ball_fields.h"
#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/drivers/common/driver_explanation.h"

namespace furrow::wrinkle {

inline constexpr float kLeastProjection = 1e-6f;  // shorter projections have no direction
// BallMode::kThesis: a bend goes to front or back if the cosine of its direction exceeds this.
inline constexpr float kThesisThreshold = 0.75f;

// BallMode::kSmooth (docs/ALGORITHM.md). Beyond this cosine, 120 degrees from straight, directions
// turn towards the side of the rest direction, so that no direction is singular above the shoulder.
inline constexpr float kTurnCosine = -0.5f;
inline constexpr float kTurnGain = 8.0f;
// Around the one singular direction that is left, where the projection is shorter, values fade.
inline constexpr float kFadeLength = 0.5f;
// Shorter projections of the rest direction turn directions less.
inline constexpr float kLeastSide = 0.5f;

// Up to sixteen ball drivers, one per lane; the fields are those of BallDriverSet::Entry.
struct BallBlock : BoneBlock {
  FloatRow straight[3];
  IntRow has_straight;  // -1; 0: the upper bone's direction counts as straight
  FloatRow forward[3];
  FloatRow right[3];
  FloatRow rest_side[2];
  FloatRow start[4];  // front, back, left, right
  FloatRow scale[4];
  BallMode mode = BallMode::kSmooth;
};

// All ball-and-socket drivers of a binding (with other limits also pivot, saddle and condyloid
// joints). Private to wrinkle/. ball_lanes-inl.h evaluates them.
class BallDriverSet {
 public:
  struct Entry : BoneEntry {
    glm::vec3 straight{0.0f};  // unit, parent's axes; zero: the upper bone's direction
    glm::vec3 forward{0.0f};   // unit, across the rest straight direction, parent's axes
    glm::vec3 right{0.0f};     // unit, across both, towards the subject's right
    // The rest direction of the lower bone, projected onto forward and right and divided by its
    // length there, or by kLeastSide if that is longer.
    glm::vec2 rest_side{0.0f};
    // The bend to front, back, left and right is clamp((start - cosine) * scale, 0, 1).
    std::array<BallRange, 4> ranges;
    BallMode mode = BallMode::kSmooth;
  };

  [[nodiscard]] Status Bind(const std::string& name, const BallDriver& driver, int first_value,
                            BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the angle of the bend and its direction, from forward towards the subject's right.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] const std::vector<BallBlock>& blocks() const { return blocks_; }

 private:
  std::vector<Entry> entries_;
  std::vector<BallBlock> blocks_;
};

}  // namespace furrow::wrinkle
