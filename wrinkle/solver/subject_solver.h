// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/rig_binding.h"
#include "wrinkle/weights/filter.h"

namespace furrow::wrinkle {

struct SubjectKernel;  // private to wrinkle/

// What a solver remembers of the poses before: one number per driver value in each list, or none
// before the first pose.
struct SolverMemory {
  std::vector<float> filtered;  // [0, 1]
  std::vector<float> inputs;    // before the filter, [0, 1]
  std::vector<float> speeds;    // 1/s
  double since_input = 0.0;     // seconds, >= 0
};

inline constexpr std::size_t kAllDrivers = std::numeric_limits<std::size_t>::max();

// The solver: evaluates one subject's poses. `furrow solve`, the load tester, the renderer and the
// daemon all run it, by itself or through BatchSolver, with the same results to the bit.
//
// - A pose becomes driver values, filtered values and wrinkle weights. The filter runs on driver
//   values, because the cubic modulation amplifies noise at neutral.
// - The drivers of a pose are evaluated side by side, in SIMD lanes, with the best instruction set
//   of the processor. Instruction sets differ in the last bits of their results.
// - Drivers compare joints with one another from the local pose alone, not in model space. Moving
//   or turning the whole character changes no bit, except in pose drivers without an anchor.
// - Allocates in the constructor and in SetLevel(), and when a thread first updates a subject of a
//   larger binding than before. A call that fails changes nothing.
// - Formulas: docs/ALGORITHM.md (thesis 4.1 to 4.6 with corrections).
class SubjectSolver {
 public:
  // `filter` false: driver values pass unfiltered; holding and decay remain.
  explicit SubjectSolver(std::shared_ptr<const RigBinding> binding, bool filter = true);

  // Evaluates a pose. `pose` has the binding's joints; coefficients past the end of
  // `pose.blend_shapes` count as 0. `dt`: seconds of capture time since the last pose, >= 0. The
  // first pose passes the filter unchanged; a later pose with dt = 0 changes no filtered value.
  // Returns kBadTime, kSizeMismatch or kNonFinite on failure.
  [[nodiscard]] JobStatus Update(const LocalPose& pose, double dt);
  // Advances time by `dt` seconds without a pose: the values hold and then decay to neutral
  // (Filter::hold_seconds, decay_seconds). Returns kBadTime on failure.
  [[nodiscard]] JobStatus Decay(double dt);
  // Seconds that Decay() has advanced since the last pose.
  [[nodiscard]] double seconds_without_pose() const { return filter_context_.since_input; }
  // Restores the state after construction, except for the number of drivers.
  void Reset();

  // What another solver of the same rig needs to go on as if it were this one.
  [[nodiscard]] SolverMemory Memory() const;
  // Goes on from there. False, and nothing has changed: the lists do not fit the binding.
  bool Remember(const SolverMemory& memory);

  // Level of detail: from the next Update() on, only the first `count` of the rig's drivers are
  // evaluated. The values of the others become 0 and fade through the filter.
  void set_num_drivers(std::size_t count) { num_drivers_ = count; }
  [[nodiscard]] std::size_t num_drivers() const { return num_drivers_; }
  // Changes the level of detail of a live subject. Drivers that join do not fade in: they begin at
  // their values in `pose`, the pose of the last Update(). The other values stay. If the subject
  // currently receives no poses, new drivers rest until it does. Returns the statuses of Update().
  [[nodiscard]] JobStatus SetLevel(const LocalPose& pose, std::size_t num_drivers);

  // The result of the last call, in [0, 1] and in the order of RigBinding::weight_names().
  [[nodiscard]] std::span<const float> wrinkle_weights() const {
    return std::span(weights_).first(binding_->weight_names().size());
  }
  // Driver values before the filter and after it, in [0, 1] and in the order of
  // RigBinding::driver_value_names().
  [[nodiscard]] std::span<const float> driver_values() const {
    const RowList& values = is_apart_ ? raw_values_ : filter_context_.raw;
    return std::span(values).first(binding_->driver_value_names().size());
  }
  [[nodiscard]] std::span<const float> filtered_values() const {
    return std::span(filter_context_.value).first(binding_->driver_value_names().size());
  }
  [[nodiscard]] const RigBinding& binding() const { return *binding_; }

 private:
  friend class BatchSolver;
  // `scratch` is shared by all subjects of a thread.
  [[nodiscard]] JobStatus Solve(const LocalPose& pose, double dt, const SubjectKernel& kernel,
                                RowList* scratch);
  void PrefetchState() const;

  std::shared_ptr<const RigBinding> binding_;  // shared, so that a stream may replace its own
  Filter filter_;
  // These lists are whole rows, for the kernel. The accessors cut them to size.
  FilterContext filter_context_;
  RowList raw_values_;
  bool is_apart_ = false;  // driver values are in raw_values_, not in the filter's last input
  RowList weights_;
  std::size_t num_drivers_ = kAllDrivers;
};

}  // namespace furrow::wrinkle
