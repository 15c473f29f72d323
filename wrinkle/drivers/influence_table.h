// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

// Which driver values each joint answers for in the dynamic masks (4.2). Private to wrinkle/.
//
// A pose driver concerns the joints of its control points; a hinge or ball its lower joint; a twist
// its joint and those it passes through; a strain driver those that move its patch; a blend shape
// none. Where several values reach one joint and
// mask, the largest counts.
class InfluenceTable {
 public:
  // The rig is already known to refer to what there is;
  // drivers with missing joints are passed over.
  void Bind(const Rig& rig, const Skeleton& skeleton,
            const std::unordered_map<std::string, int>& value_index);

  [[nodiscard]] std::span<const DynamicMask> masks() const { return masks_; }

  // `influences`: num_joints x num masks, joint-major; all of it is written.
  void Evaluate(std::span<const float> driver_values, std::span<float> influences) const;

 private:
  struct Entry {
    std::uint32_t place = 0;  // joint * num masks + mask
    int driver_value = 0;
    float gain = 1.0f;
    Modulation modulation = Modulation::kCosine;
  };
  [[nodiscard]] std::size_t MaskOf(int map, const Mask& mask);

  std::vector<DynamicMask> masks_;
  std::vector<Entry> entries_;
};

}  // namespace furrow::wrinkle
