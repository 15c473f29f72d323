// SPDX-License-Identifier: Apache-2.0
// Pose drivers of one subject, many side by side: pose_projection.h, lane by lane; and the points
// of those that are solved alone.
#if defined(FURROW_WRINKLE_BATCH_POSES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_POSES_INL_H_
#undef FURROW_WRINKLE_BATCH_POSES_INL_H_
#else
#define FURROW_WRINKLE_BATCH_POSES_INL_H_
#endif

#include <array>

#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/simd/batch_math-inl.h"
#include "wrinkle/simd/batch_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// A control point's departure from rest.
template <bool kScaled>
HWY_INLINE Float3 MovePoint(const LanePlan& plan, const PointRow& row, LanePose<kScaled> pose,
                            std::size_t lane) {
  return EvaluatePoint(plan, row, pose, lane) - LoadRows(row.rest, lane);
}

// One point, no falloff: the most of them, so all stays in registers.
template <bool kScaled>
void EvaluateOnePoint(const LanePlan& plan, const PoseBlock& block, LanePose<kScaled> pose,
                      std::size_t lane, float* values) {
  const Float3 moved = MovePoint(plan, plan.points[block.first_point], pose, lane);
  const FloatRow* projection = plan.projections.data() + block.first_projection;
  for (std::uint32_t k = 0; k < block.num_values; ++k, projection += 3, values += kRowLanes) {
    StoreLanes(Saturate(Dot(moved, LoadRows(projection, lane))), values);
  }
}

// Block by block, the next one's joints loaded before this one's values are worked out: processors
// look ahead no further than that.
template <bool kScaled>
void EvaluateLeaves(const LanePlan& plan, LanePose<kScaled> pose, std::size_t num_values,
                    float* rows) {
  const FloatRow* const projections = plan.projections.data();
  const LeafBlock* const end = plan.leaves.data() + plan.leaves.size();
  const auto reached = [=](const LeafBlock* leaf) {
    while (leaf != end && leaf->first_value >= num_values) ++leaf;
    return leaf;
  };
  const LeafBlock* const first = reached(plan.leaves.data());
  if (first == end) return;
  for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes) {
    JointLanes next = LoadJoint(pose.numbers, first->joints.at + lane);
    for (const LeafBlock* leaf = first; leaf != end;) {
      const LeafBlock& now = *leaf;
      const JointLanes joint = next;
      leaf = reached(leaf + 1);
      if (leaf != end) next = LoadJoint(pose.numbers, leaf->joints.at + lane);
      const Float3 moved = Up(pose, now.joints.at + lane, joint, LoadRows(now.offset, lane)) -
                           LoadRows(now.rest, lane);
      const FloatRow* projection = projections + now.first_projection;
      float* to = rows + now.first_row * kRowLanes + lane;
      for (std::uint32_t k = 0; k < now.num_values; ++k, projection += 3, to += kRowLanes) {
        StoreLanes(Saturate(Dot(moved, LoadRows(projection, lane))), to);
      }
    }
  }
}

// Falloff() of SquaredDistance(). `rows`: the width, then each point's displacement.
inline Float LaneFalloff(std::span<const Float3> moved, const FloatRow* rows, Float along,
                         std::size_t lane) {
  Float sum = hn::Zero(Floats());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Float3 difference = moved[i] - along * LoadRows(rows + 1 + 3 * i, lane);
    sum = hn::Add(sum, Dot(difference, difference));
  }
  return Exponential(hn::Div(hn::Neg(sum), LoadRow(*rows, lane)));
}

template <bool kScaled>
void EvaluatePoints(const LanePlan& plan, const PoseBlock& block, LanePose<kScaled> pose,
                    std::size_t lane, float* values) {
  std::array<Float3, kMaxControlPoints> points;
  const std::span<Float3> moved(points.data(), block.num_points);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] = MovePoint(plan, plan.points[block.first_point + i], pose, lane);
  }
  const FloatRow* projection = plan.projections.data() + block.first_projection;
  const FloatRow* falloff = plan.falloffs.data() + block.first_falloff;
  for (std::uint32_t k = 0; k < block.num_values; ++k, values += kRowLanes) {
    Float along = hn::Zero(Floats());
    for (const Float3& m : moved) {
      along = hn::Add(along, Dot(m, LoadRows(projection, lane)));
      projection += 3;
    }
    Float value = Saturate(along);
    if (block.has_falloff) {
      value = Saturate(hn::Mul(value, LaneFalloff(moved, falloff, along, lane)));
      falloff += 1 + 3 * moved.size();
    }
    StoreLanes(value, values);
  }
}

template <bool kScaled>
void Evaluate(const LanePlan& plan, const PoseBlock& block, LanePose<kScaled> pose,
              std::size_t lane, float* values) {
  if (block.num_points == 1 && !block.has_falloff) {
    EvaluateOnePoint(plan, block, pose, lane, values);
  } else {
    EvaluatePoints(plan, block, pose, lane, values);
  }
}

HWY_INLINE void StoreRows(Float3 v, float* rows) {
  StoreLanes(v.x, rows);
  StoreLanes(v.y, rows + kRowLanes);
  StoreLanes(v.z, rows + 2 * kRowLanes);
}

// How far points have moved, into three rows.
template <bool kScaled>
void EvaluateMoved(const LanePlan& plan, const LonePoints& points, LanePose<kScaled> pose,
                   std::size_t lane, float* rows) {
  StoreRows(MovePoint(plan, plan.points[points.first_point], pose, lane), rows);
}

// What joints make of four points each, into twelve rows.
template <bool kScaled>
void EvaluateFrames(const LanePlan& plan, const LonePoints& frames, LanePose<kScaled> pose,
                    std::size_t lane, float* rows) {
  const FourPoints four = EvaluateFour(plan, &plan.points[frames.first_point], pose, lane);
  for (const Float3& point : four.at) {
    StoreRows(point, rows);
    rows += 3 * kRowLanes;
  }
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
