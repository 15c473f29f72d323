// SPDX-License-Identifier: Apache-2.0
// The solver of one subject, compiled once for each instruction set and chosen at run time: Highway
// includes this file again and again. SSSE3 is left out (processors that have it but not
// SSE4 are rare), and so are vectors without a fixed size (SVE, RVV), which no struct can hold.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wrinkle/simd/batch_kernel.cpp"
#include "wrinkle/simd/batch_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "wrinkle/simd/batch_check-inl.h"
#include "wrinkle/simd/batch_drivers-inl.h"
#include "wrinkle/simd/batch_filter-inl.h"
#include "wrinkle/simd/batch_poses-inl.h"
#include "wrinkle/simd/batch_weights-inl.h"
#include "wrinkle/solver/lone_drivers.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Those blocks that the level of detail reaches, into their rows, `kLanes` at a time.
template <class Block, class Function>
HWY_INLINE void ForEach(const std::vector<Block>& blocks, const SubjectJob& job, float* rows,
                        Function function) {
  for (const Block& block : blocks) {
    if (block.first_value >= job.num_values) continue;
    for (std::size_t lane = 0; lane < block.num_lanes; lane += kLanes) {
      function(block, lane, rows + block.first_row * kRowLanes + lane);
    }
  }
}

template <bool kScaled>
void EvaluateBlocks(const SubjectJob& job, LanePose<kScaled> pose, float* rows) {
  const LanePlan& plan = job.binding->lanes;
  const auto evaluate = [&](const auto& block, std::size_t lane, float* to)
                            HWY_ATTR { Evaluate(plan, block, pose, lane, to); };
  EvaluateLeaves(plan, pose, job.num_values, rows);
  ForEach(plan.poses, job, rows, evaluate);
  ForEach(plan.hinges, job, rows, evaluate);
  ForEach(plan.balls, job, rows, evaluate);
  ForEach(plan.twists, job, rows, evaluate);
  ForEach(plan.blend_shapes, job, rows,
          [&](const BlendShapeBlock& block, std::size_t lane, float* to)
              HWY_ATTR { Evaluate(block, job.blend_shapes, lane, to); });
  ForEach(plan.nnls_points, job, rows,
          [&](const LonePoints& points, std::size_t lane, float* to)
              HWY_ATTR { EvaluateMoved(plan, points, pose, lane, to); });
  ForEach(plan.strain_frames, job, rows,
          [&](const LonePoints& frames, std::size_t lane, float* to)
              HWY_ATTR { EvaluateFrames(plan, frames, pose, lane, to); });
}

bool Solve(const SubjectJob& job, float* scratch) {
  const FilterLanes filter = MakeFilterLanes(*job.filter, job.context->since_input, job.dt);
  const PoseCheck check = CheckPose(job.pose);
  if (!check.is_finite || !AllFiniteLanes(job.blend_shapes)) return false;
  const float* const numbers = job.pose.empty() ? nullptr : &job.pose.front().translation.x;
  if (check.is_scaled) {
    EvaluateBlocks(job, LanePose<true>{numbers}, scratch);
  } else {
    EvaluateBlocks(job, LanePose<false>{numbers}, scratch);
  }
  const BindingData& data = *job.binding;
  if (data.lanes.HasLoneDrivers()) EvaluateLoneDrivers(data, job.num_values, scratch);
  FilterSubject(job, filter, scratch);
  EvaluateWeights(data.weight_plan, job.context->value.data(),
                  scratch + data.lanes.num_rows * kRowLanes, job.weights);
  return true;
}

SubjectSolve* BestSolve() { return Solve; }

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace furrow::wrinkle {

HWY_EXPORT(BestSolve);

std::size_t ScratchSize(const BindingData& binding) {
  return (binding.lanes.num_rows + binding.weight_plan.num_rows()) * kRowLanes;
}

SubjectSolve* BestSubjectSolve() { return HWY_DYNAMIC_DISPATCH(BestSolve)(); }

}  // namespace furrow::wrinkle
#endif  // HWY_ONCE
