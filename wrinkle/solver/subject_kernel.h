// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "wrinkle/solver/binding_data.h"
#include "wrinkle/weights/filter.h"

namespace furrow::wrinkle {

// One pose of one subject. Private to wrinkle/.
struct SubjectJob {
  const BindingData* binding = nullptr;
  std::size_t num_values = 0;       // of the drivers to evaluate; the binding's other values are 0
  std::span<const Transform> pose;  // num_joints
  std::span<const float> blend_shapes;
  const Filter* filter = nullptr;
  FilterContext* context = nullptr;  // whole rows
  double dt = 0.0;
  // Receives the driver values if the filter does not take them over (FilterMove::kStay). Whole
  // rows.
  float* raw_values = nullptr;
  bool* is_apart = nullptr;  // out: true if `raw_values` was written
  float* weights = nullptr;  // out; whole rows
};

// The solver's functions, compiled for one instruction set. All lists of floats are whole rows
// (RowList).
struct SubjectKernel {
  // Drivers, filter and wrinkle weights of one pose. `scratch` has ScratchSize() floats, was zero
  // when first used, and may serve any subjects and bindings in turn. Returns false, and changes
  // nothing, if a number of the pose is not finite.
  bool (*solve)(const SubjectJob& job, float* scratch);
  // Driver values to wrinkle weights. `modulated`: scratch memory of plan.num_rows() rows.
  void (*weights)(const WeightPlan& plan, const float* values, float* modulated, float* weights);
  // The first half of `weights`: combined and modulated, before incongruence is resolved.
  void (*modulate_all)(const WeightPlan& plan, const float* values, float* modulated);
  ModulateRow* modulate;
  // The factor that an opposed weight leaves of a weight.
  float (*congruence)(float own, float other);
};

// The number of floats of scratch memory that a binding needs.
[[nodiscard]] std::size_t ScratchSize(const BindingData& binding);

// The kernel for the best instruction set of this processor.
[[nodiscard]] const SubjectKernel& BestSubjectKernel();

}  // namespace furrow::wrinkle
