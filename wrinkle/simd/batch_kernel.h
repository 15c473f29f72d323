// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {

// One subject's part of a batch. Private to wrinkle/.
struct SubjectJob {
  const BindingData* binding = nullptr;
  std::size_t num_values = 0;       // those of the drivers to evaluate; the binding's others are 0
  std::span<const Transform> pose;  // num_joints
  std::span<const float> blend_shapes;
  const Filter* filter = nullptr;
  FilterContext* context = nullptr;  // whole rows
  double dt = 0.0;
  // Out, where the filter does not take them as its input (FilterMove::kStay).
  float* raw_values = nullptr;  // whole rows (RowList)
  bool* is_apart = nullptr;     // whether they are there
  float* weights = nullptr;     // out; whole rows
};

// How many floats a SubjectSolve needs for itself: a RowList, zero when it first sees it. They keep
// nothing: subjects of any bindings may take turns.
[[nodiscard]] std::size_t ScratchSize(const BindingData& binding);

// Drivers, filter and wrinkle weights. False: a number of the pose is not finite; nothing has
// changed.
using SubjectSolve = bool(const SubjectJob& job, float* scratch);

// By the best instructions that this processor has.
[[nodiscard]] SubjectSolve* BestSubjectSolve();

}  // namespace furrow::wrinkle
