// SPDX-License-Identifier: Apache-2.0
// The solver of one subject, compiled once per instruction set and chosen at run time: Highway
// includes this file repeatedly. SSSE3 is left out, because few processors have it without SSE4,
// and so are vectors without a fixed size (SVE, RVV), because a struct cannot hold them.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wrinkle/solver/subject_kernel.cpp"
#include "wrinkle/solver/subject_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#define FURROW_DRIVER_LANES
#include "wrinkle/drivers/driver_kinds.h"
#include "wrinkle/simd/pose_check-inl.h"
#include "wrinkle/weights/filter_lanes-inl.h"
#include "wrinkle/weights/weight_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

template <bool kScaled>
void EvaluateAllDrivers(const SubjectJob& job, LanePose<kScaled> pose, float* rows) {
  const DriverInput input{.num_values = job.num_values, .blend_shapes = job.blend_shapes};
  const PointPlan& points = job.binding->points;
  const BoundDrivers& drivers = job.binding->drivers;
#define FURROW_KIND_EVALUATE(Name, field) EvaluateDrivers(drivers.field, points, pose, input, rows);
  FURROW_DRIVER_KINDS(FURROW_KIND_EVALUATE)
#undef FURROW_KIND_EVALUATE
}

bool Solve(const SubjectJob& job, float* scratch) {
  // Computed first: its divisions finish while the pose is loaded.
  const FilterFactors factors = MakeFilterFactors(*job.filter, job.context->since_input, job.dt);
  const PoseCheck check = CheckPose(job.pose);
  if (!check.is_finite || !AllFiniteLanes(job.blend_shapes)) return false;
  // The kernel reads the joints as one list of floats (lane_points-inl.h).
  const float* const numbers = job.pose.empty() ? nullptr : &job.pose.front().translation.x;
  // Two instances of the evaluator: most streams have no scales and skip their loads and products.
  if (check.is_scaled) {
    EvaluateAllDrivers(job, LanePose<true>{numbers}, scratch);
  } else {
    EvaluateAllDrivers(job, LanePose<false>{numbers}, scratch);
  }
  // The scratch memory holds the rows of driver values, then the rows of modulated weights, then
  // those of the filter.
  const BindingData& data = *job.binding;
  float* const modulated = scratch + data.num_value_rows * kRowLanes;
  FilterValues({.filter = *job.filter,
                .factors = factors,
                .dt = job.dt,
                .inputs = data.values,
                .num_inputs = job.num_values,
                .context = job.context,
                .raw_values = job.raw_values,
                .is_apart = job.is_apart,
                .scratch = modulated + data.weight_plan.num_rows() * kRowLanes},
               scratch);
  // The weights read the filtered values, because filtering before modulation does not amplify
  // noise.
  EvaluateWeights(data.weight_plan, job.context->value.data(), modulated, job.weights);
  return true;
}

const SubjectKernel* Kernel() {
  static constexpr SubjectKernel kKernel{.solve = Solve,
                                         .weights = EvaluateWeights,
                                         .modulate_all = ModulateAll,
                                         .modulate = ModulateLanes,
                                         .congruence = CongruenceOf};
  return &kKernel;
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace furrow::wrinkle {

HWY_EXPORT(Kernel);

// Row 0 holds zeros for drivers that rest. No binding writes to it, so one list serves all
// bindings.
std::size_t ScratchSize(const BindingData& binding) {
  const std::size_t num_rows = binding.num_value_rows + binding.weight_plan.num_rows() +
                               kFilterRows * binding.values.num_rows();
  return num_rows * kRowLanes;
}

const SubjectKernel& BestSubjectKernel() { return *HWY_DYNAMIC_DISPATCH(Kernel)(); }

}  // namespace furrow::wrinkle
#endif  // HWY_ONCE
