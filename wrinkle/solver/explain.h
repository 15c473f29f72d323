// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/drivers/common/driver_explanation.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/rig_binding.h"

namespace furrow::wrinkle {

// How one pose led to its wrinkle weights, with every number on the way, for `furrow rig explain`.
// Driver values, combined and modulated weights, factors and results come from the solver itself.
// The geometry of the drivers (DriverExplanation) is measured from the same pose.
struct Explanation : DriverExplanation {
  // One driver value that feeds a weight.
  struct Contribution {
    std::string driver_value;  // "<driver>.<value>"
    float value = 0.0f;
    float gain = 1.0f;
    // The value, or with Combine::kSumModulated the modulated value.
    float modulated = 0.0f;
    float product = 0.0f;  // gain * modulated, before combining
  };
  // The weight of a neighbouring region on an opposed map, and the factor that it leaves.
  struct Conflict {
    std::string weight;
    float other = 0.0f;  // that weight before incongruence is resolved
    float factor = 1.0f;
  };
  struct Weight {
    std::string name;  // "<region>.<map>"
    std::vector<Contribution> contributions;
    float combined = 0.0f;  // without modulation
    float modulated = 0.0f;
    std::string_view modulation;  // ModulationName()
    std::vector<Conflict> conflicts;
    float result = 0.0f;  // after incongruence: the weight that is sent
  };
  std::vector<Weight> weights;  // in the order of RigBinding::weight_names()
};

// Explains `pose` by itself, without filter and history. Returns the failures of
// SubjectSolver::Update(), and then leaves `explanation` unchanged.
[[nodiscard]] JobStatus Explain(const RigBinding& binding, const LocalPose& pose,
                                Explanation* explanation);

}  // namespace furrow::wrinkle
