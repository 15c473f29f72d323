// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "wrinkle/binding_data.h"

namespace furrow::wrinkle {

inline constexpr std::size_t kMaxBatchLanes = 16;

// `count` rounded up to what fills the widest vectors.
[[nodiscard]] constexpr std::size_t WholeVectors(std::size_t count) {
  return (count + kMaxBatchLanes - 1) / kMaxBatchLanes * kMaxBatchLanes;
}

// Subjects of one binding that are evaluated side by side, one a lane. Lanes past `count` repeat
// subject 0. Private to wrinkle/.
struct BatchGroup {
  template <class T>
  using Each = std::array<T, kMaxBatchLanes>;

  const BindingData* binding = nullptr;
  std::size_t num_values = 0;  // those of the drivers to evaluate; the binding's others are 0
  std::size_t count = 0;
  Each<const Transform*> poses{};  // num_joints each
  Each<const float*> joints{};     // the same, as numbers
  Each<std::span<const float>> blend_shapes{};
  Each<const Filter*> filters{};
  Each<FilterContext*> contexts{};
  Each<double> dt{};
  Each<float*> raw_values{};  // out; as long as WholeVectors(), like the contexts' lists
  Each<float*> weights{};     // out; WholeVectors()
};

// How many floats a group needs for itself, aligned to kBatchAlignment bytes.
inline constexpr std::size_t kBatchAlignment = 64;
[[nodiscard]] std::size_t BatchScratchSize(const BindingData& binding);

// Lanes of the best instructions that this processor has: the size of a full group.
[[nodiscard]] std::size_t BatchLanes();

// As AllFinite() of finite.h, faster.
[[nodiscard]] bool BatchAllFinite(std::span<const float> values);

// The subject's nnls and strain drivers, which are not evaluated side by side, into raw_values.
void EvaluateOneByOne(const BatchGroup& group, std::size_t subject);

// The values of the group's drivers, into `scratch`. Nothing else changes.
//
// Returns a bit for each lane whose pose may hold a number that is not finite among those that the
// drivers read (NumbersRead()); finite numbers that overflow set it, too.
[[nodiscard]] unsigned EvaluateGroup(const BatchGroup& group, float* scratch);

// Filter and wrinkle weights of what EvaluateGroup() left, into the subjects' outputs.
void FinishGroup(const BatchGroup& group, float* scratch);

}  // namespace furrow::wrinkle
