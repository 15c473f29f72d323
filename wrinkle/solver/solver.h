// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wrinkle/rig/rig.h"
#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::wrinkle {

struct BindingData;  // the rig compiled for one skeleton, in evaluation order; private to wrinkle/

struct BindOptions {
  // false: a joint or blend shape that the skeleton lacks is an error. true (live streams): its
  // driver rests at 0, and it is listed in missing_joints() / missing_blend_shapes().
  bool allow_missing = false;
  // (the rig's joint, the skeleton's): tried where the skeleton has no joint of the rig's name.
  std::span<const std::pair<std::string, std::string>> aliases;
};

// The skinning masks of one wrinkle map that fade alike with the skin weight: a column of
// JointInfluenceJob.
struct DynamicMask {
  int map = 0;  // of Rig::wrinkle_maps
  LambdaMode lambda = LambdaMode::kSmooth;
  float smooth_width = 0.25f;

  friend bool operator==(const DynamicMask&, const DynamicMask&) = default;
};

// A rig bound to one skeleton: names resolved, reference poses turned into displacements,
// immutable, shared by all subjects of that skeleton.
class RigBinding {
 public:
  // Errors: CheckRigFields()'s (rig_check.h), kNotFound (names the driver and the joint), and
  // kInvalidArgument for a driver that makes no sense on this skeleton.
  [[nodiscard]] static Result<RigBinding> Create(const Rig& rig, const Skeleton& skeleton,
                                                 std::span<const std::string> blend_shape_names,
                                                 const BindOptions& options = {});
  RigBinding(RigBinding&&) noexcept;
  RigBinding& operator=(RigBinding&&) noexcept;
  ~RigBinding();

  // "<region>.<map>", in the order of the rig's regions and their feeds.
  [[nodiscard]] std::span<const std::string> weight_names() const;
  // "<driver>.<value>", in the order of the rig's drivers.
  [[nodiscard]] std::span<const std::string> driver_value_names() const;
  // One a wrinkle map and lambda that skinning masks ask for, in the order of the rig's regions.
  [[nodiscard]] std::span<const DynamicMask> dynamic_masks() const;
  [[nodiscard]] std::span<const std::string> missing_joints() const;
  [[nodiscard]] std::span<const std::string> missing_blend_shapes() const;
  // What binds but cannot do what was meant: a reference pose that moves none of its driver's
  // control points (I_k is 0 for good), a control point that does not hang from the anchor and,
  // where things may be missing, a driver that makes no sense on this skeleton.
  [[nodiscard]] std::span<const std::string> warnings() const;
  [[nodiscard]] const Skeleton& skeleton() const;
  [[nodiscard]] const Rig& rig() const;
  [[nodiscard]] const BindingData& data() const { return *data_; }

 private:
  explicit RigBinding(std::unique_ptr<BindingData> data);
  std::unique_ptr<BindingData> data_;
};

inline constexpr std::size_t kAllDrivers = std::numeric_limits<std::size_t>::max();

// Pose to driver values, unfiltered: `<driver>.<value>` in [0, 1].
//
// - `local` num_joints of the binding's skeleton; `blend_shapes` as bound (may be shorter: 0).
// - `driver_values` at least driver_value_names().size() long. Does not allocate.
// - `num_drivers`: a level of detail. Of the rig's drivers only so many, in the rig's order, are
//   evaluated; the values of the others are 0, as where a driver's joints are missing.
// - Drivers compare joints with one another from the local pose alone, not in model space: where
//   the character stands and how it is turned changes no value by a single bit (but for the pose
//   drivers of a rig without an anchor).
// Source: thesis 4.1, 4.6 with the corrections of docs/ALGORITHM.md; strain drivers are ours.
struct DriverJob {
  const RigBinding* binding = nullptr;
  std::span<const Transform> local;
  std::span<const float> blend_shapes;
  std::span<float> driver_values;
  std::size_t num_drivers = kAllDrivers;

  [[nodiscard]] JobStatus Validate() const;
  [[nodiscard]] JobStatus Run() const;
};

// Driver values to wrinkle weights: combine, modulate,
// resolve incongruence. Stateless, no allocation.
struct WrinkleWeightsJob {
  const RigBinding* binding = nullptr;
  std::span<const float> driver_values;
  std::span<float> wrinkle_weights;  // at least weight_names().size()

  [[nodiscard]] JobStatus Validate() const;
  [[nodiscard]] JobStatus Run() const;
};

// What the filter remembers of one subject: owned by the caller, sized once by Resize().
struct FilterContext {
  RowList value;             // last output
  RowList raw;               // last input
  RowList derivative;        // low-passed, 1/s
  double since_input = 0.0;  // seconds since the last real input
  bool started = false;

  void Resize(int num_values);
  void Reset();  // as after Resize(): the next input passes unchanged
};

// One-Euro, slew and (without input) hold and decay, applied to driver values or weights alike.
//
// - `dt` seconds since the last call, >= 0. The first input passes unchanged; a later one at dt = 0
//   changes nothing.
// - `input` empty: nothing arrived; the output holds for Filter::hold_seconds, then decays to 0.
// - Filter::enabled false: input passes as it is; hold and decay stay.
// - `output` as long as the context; may be its `value`. Outputs stay in [0, 1].
// - Does not allocate. Formulas: one_euro.h.
struct FilterJob {
  const Filter* filter = nullptr;
  FilterContext* context = nullptr;
  double dt = 0.0;
  std::span<const float> input;
  std::span<float> output;

  [[nodiscard]] JobStatus Validate() const;
  [[nodiscard]] JobStatus Run() const;
};

// All of a subject's evaluation, in the order the daemon, `furrow solve` and the renderer share:
// driver values -> filter (on driver values, since cubic amplifies noise at neutral) -> wrinkle
// weights. Allocates in the constructor alone. A call that fails changes nothing.
class SubjectSolver {
 public:
  // `binding` outlives the solver (shared so that a stream may swap it).
  explicit SubjectSolver(std::shared_ptr<const RigBinding> binding, bool filter = true);

  // `pose` has the binding's joints. `dt`: seconds of capture time since the last pose.
  [[nodiscard]] JobStatus Update(const LocalPose& pose, double dt);
  // No pose arrived for `dt`: hold, then decay to neutral.
  [[nodiscard]] JobStatus Decay(double dt);
  void Reset();

  // A level of detail: from the next Update() on only the first `count` of the rig's drivers count
  // (DriverJob::num_drivers); the others' values fade through the filter.
  void set_num_drivers(std::size_t count) { num_drivers_ = count; }
  [[nodiscard]] std::size_t num_drivers() const { return num_drivers_; }

  [[nodiscard]] std::span<const float> wrinkle_weights() const {
    return std::span(weights_).first(binding_->weight_names().size());
  }
  // Driver values before the filter, and after it.
  [[nodiscard]] std::span<const float> driver_values() const {
    const RowList& values = is_apart_ ? raw_values_ : filter_context_.raw;
    return std::span(values).first(binding_->driver_value_names().size());
  }
  [[nodiscard]] std::span<const float> filtered_values() const {
    return std::span(filter_context_.value).first(binding_->driver_value_names().size());
  }
  [[nodiscard]] const RigBinding& binding() const { return *binding_; }

 private:
  friend class BatchSolver;  // advances many subjects at once
  [[nodiscard]] JobStatus Finish(double dt, std::span<const float> input);

  std::shared_ptr<const RigBinding> binding_;
  Filter filter_;
  // As long as whole rows (lane_rows.h), for BatchSolver; nobody reads what is too much.
  FilterContext filter_context_;
  RowList raw_values_;
  bool is_apart_ = false;  // raw_values_ are the last ones, else the filter's last input is
  RowList weights_;
  std::size_t num_drivers_ = kAllDrivers;
};

// The dynamic masks' per-joint part (4.2): for regions with a skinning mask, how strongly each
// joint calls for each of a region's maps, already modulated. The vertex side is clamp(sum over its
// influences of lambda(skin_weight) * influence, 0, 1); see shaders/.
//
// - `influences` is num_joints * dynamic_masks().size(), joint-major. Does not allocate.
// - A pose driver concerns its control points' joints, a hinge or ball its lower joint, a twist all
//   of its joints, a strain driver those that move its patch, a blend shape none; the largest of a
//   joint's influences on a map counts.
// - The vertex side for the processor, and lambda: vertex_influence.h.
struct JointInfluenceJob {
  const RigBinding* binding = nullptr;
  std::span<const float> driver_values;  // filtered
  std::span<float> influences;

  [[nodiscard]] JobStatus Validate() const;
  [[nodiscard]] JobStatus Run() const;
};

}  // namespace furrow::wrinkle
