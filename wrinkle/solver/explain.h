// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

// How one pose came to its wrinkle weights: every number on the way, for `furrow rig explain`. It
// is computed by the code that the jobs run, not by a second copy of the formulas.
struct Explanation {
  // One driver value that feeds a weight.
  struct Contribution {
    std::string driver_value;  // "<driver>.<value>"
    float value = 0.0f;        // as given to WrinkleWeightsJob
    float gain = 1.0f;
    float product = 0.0f;  // gain * value, before combining
  };
  // A weight of a neighbouring region on an opposed map, and the factor that it leaves.
  struct Conflict {
    std::string weight;
    float other = 0.0f;  // that weight before incongruence is resolved
    float factor = 1.0f;
  };
  struct Weight {
    std::string name;  // "<region>.<map>"
    std::vector<Contribution> contributions;
    float combined = 0.0f;
    float modulated = 0.0f;
    std::vector<Conflict> conflicts;
    float result = 0.0f;  // after incongruence: what is sent
  };
  // A pose driver's value (4.1). Lengths are in the skeleton's units, seen from the anchor.
  struct PoseValue {
    std::string driver_value;
    float displacement = 0.0f;   // |d|: rest to reference pose
    float moved = 0.0f;          // rest to this pose
    float numerator = 0.0f;      // dot(moved, d)
    float along = 0.0f;          // numerator / |d|^2, or the nnls weight; not clamped
    float perpendicular = 0.0f;  // what the projection, or the whole fit, leaves over
    float falloff = 1.0f;        // factor for that
    float result = 0.0f;
  };
  // A hinge, ball or twist driver's geometry, in degrees.
  struct Angle {
    std::string driver;
    // "flexion", "bend", "direction" (from forward towards the subject's right) or "twist".
    std::string what;
    float degrees = 0.0f;
  };
  // A strain driver's patch.
  struct Strain {
    std::string driver;
    float smallest = 1.0f;  // principal stretches, area mean of the patch
    float largest = 1.0f;
    // Of the strongest compression, from the driver's direction to the left as seen from outside,
    // (-90, 90].
    float degrees = 0.0f;
  };
  std::vector<Weight> weights;         // in the order of RigBinding::weight_names()
  std::vector<PoseValue> pose_values;  // drivers with missing joints are left out, here and below
  std::vector<Angle> angles;
  std::vector<Strain> strains;
};

// Explains `pose` on its own: no filter, no history. `explanation` is untouched on failure.
[[nodiscard]] JobStatus Explain(const RigBinding& binding, const LocalPose& pose,
                                Explanation* explanation);

}  // namespace furrow::wrinkle
