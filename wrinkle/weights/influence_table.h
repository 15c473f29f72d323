// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "wrinkle/rig/rig.h"
#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/weights/modulation_row.h"

namespace furrow::wrinkle {

// The skinning masks of one wrinkle map that fade in the same way with the skin weight: a column of
// JointInfluenceJob.
struct DynamicMask {
  int map = 0;  // of Rig::wrinkle_maps
  LambdaMode lambda = LambdaMode::kSmooth;
  float smooth_width = 0.25f;

  friend bool operator==(const DynamicMask&, const DynamicMask&) = default;
};

// The driver values that each joint responds to in the dynamic masks (4.2). JointsInfluenced() of
// the driver's kind lists the joints. The largest of several influences on one joint and mask
// counts. Private to wrinkle/.
class InfluenceTable {
 public:
  // Precondition: the names in `rig` are valid. Drivers with missing joints are skipped.
  void Bind(const Rig& rig, const Skeleton& skeleton,
            const std::unordered_map<std::string, int>& value_index);

  [[nodiscard]] std::span<const DynamicMask> masks() const { return masks_; }

  // The influences that some driver values raise above 0, as indices of Evaluate()'s result,
  // sorted.
  [[nodiscard]] std::vector<std::size_t> Places() const;

  // Writes all influences: num_joints x num masks, joint-major. `modulate` is the kernel's.
  void Evaluate(std::span<const float> driver_values, ModulateRow* modulate,
                std::span<float> influences) const;

 private:
  struct Entry {
    std::size_t joint = 0;
    std::size_t mask = 0;
    int driver_value = 0;
    float gain = 1.0f;
    FeedModulation modulation;
  };
  // Sixteen entries, modulated side by side.
  struct Block {
    std::array<std::size_t, kRowLanes> places{};  // joint * num masks + mask
    std::array<int, kRowLanes> driver_values{};
    std::array<float, kRowLanes> gains{};
    ModulationRow modulation;
    std::size_t num_lanes = 0;
  };
  [[nodiscard]] std::size_t MaskOf(int map, const Mask& mask);

  std::vector<DynamicMask> masks_;
  std::vector<Block> blocks_;
};

}  // namespace furrow::wrinkle
