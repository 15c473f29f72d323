// SPDX-License-Identifier: Apache-2.0
// Computes points of one pose, one chain of joints per SIMD lane, with the results of
// JointChains::Evaluate() to the bit.
#if defined(FURROW_WRINKLE_LANE_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_LANE_POINTS_INL_H_
#undef FURROW_WRINKLE_LANE_POINTS_INL_H_
#else
#define FURROW_WRINKLE_LANE_POINTS_INL_H_
#endif

#include <cstddef>
#include <span>
#include <vector>

#include "wrinkle/simd/lanes-inl.h"
#include "wrinkle/simd/point_plan.h"
#include "wrinkle/skeleton/transform.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Loads take four or eight numbers at once and rely on this layout: translation 0 to 2, rotation 3
// to 6 (x, y, z, w), scale 7 to 9.
constexpr std::size_t kJointFloats = sizeof(Transform) / sizeof(float);
constexpr std::size_t kRotationFloat = offsetof(Transform, rotation) / sizeof(float);
constexpr std::size_t kScaleFloat = offsetof(Transform, scale) / sizeof(float);
static_assert(kJointFloats == 10 && kRotationFloat == 3 && kScaleFloat == 7 &&
              offsetof(glm::quat, x) == 0 && offsetof(glm::quat, w) == 12);

// A subject's pose as a list of numbers. `kScaled` is false if every scale is 1, as in most
// streams: scales are then neither loaded nor multiplied.
template <bool kScaled>
struct LanePose {
  const float* numbers;
};

// The translation and rotation of one joint per lane.
struct JointLanes {
  Float3 translation;
  FloatQuat rotation;
};

// These load a part of the joint at each lane's place in `joints` (JointStep::joints).
// The fourth column is the rotation's x, which is ignored.
HWY_INLINE Float3 LoadTranslation(const float* numbers, const std::int32_t* joints) {
  const Columns columns = LoadColumns(numbers, joints);
  return {columns.c0, columns.c1, columns.c2};
}

HWY_INLINE FloatQuat LoadRotation(const float* numbers, const std::int32_t* joints) {
  const Columns columns = LoadColumns(numbers + kRotationFloat, joints);
  return {columns.c0, columns.c1, columns.c2, columns.c3};
}

HWY_INLINE Float3 LoadScale(const float* numbers, const std::int32_t* joints) {
  // Loads from one number earlier, so that no read goes past the joint.
  const Columns columns = LoadColumns(numbers + kScaleFloat - 1, joints);
  return {columns.c1, columns.c2, columns.c3};
}

// The eighth number is the scale's x, which is ignored.
HWY_INLINE JointLanes LoadJoint(const float* numbers, const std::int32_t* joints) {
  const TwoColumns both = LoadTwoColumns(numbers, joints);
  return {{both.begin.c0, both.begin.c1, both.begin.c2},
          {both.begin.c3, both.end.c0, both.end.c1, both.end.c2}};
}

// From the joint's space to its parent's space.
template <bool kScaled>
HWY_INLINE Float3 Up(LanePose<kScaled> pose, const std::int32_t* joints, const JointLanes& joint,
                     Float3 v) {
  if constexpr (kScaled) v = LoadScale(pose.numbers, joints) * v;
  return joint.translation + Rotate(joint.rotation, v);
}

// From the parent's space to the joint's space.
template <bool kScaled>
HWY_INLINE Float3 Down(LanePose<kScaled> pose, const std::int32_t* joints, const JointLanes& joint,
                       Float3 v) {
  v = Rotate(Conjugate(joint.rotation), v - joint.translation);
  if constexpr (kScaled) v = v / LoadScale(pose.numbers, joints);
  return v;
}

// `moved` in lanes with a joint at this step, `v` in lanes with a chain that has ended.
HWY_INLINE Float3 WhereActive(const JointStep& step, std::size_t lane, Float3 moved, Float3 v) {
  return step.all_active ? moved : IfThenElse(LoadMask(step.active, lane), moved, v);
}

// Follows each lane's chain: up from the point's joint to a shared ancestor, then down to the space
// in which the point is measured. Lanes with shorter chains wait at their last position.
template <bool kScaled>
HWY_INLINE Float3 EvaluatePoint(const PointPlan& plan, const PointRow& row, LanePose<kScaled> pose,
                                std::size_t lane) {
  const JointStep* step = plan.steps.data() + row.first_step;  // may be the end
  const JointStep* const top = step + row.num_up;
  const JointStep* const end = top + row.num_down;
  Float3 position;
  if (row.is_origin) {
    position = LoadTranslation(pose.numbers, (step++)->joints.at + lane);
  } else {
    position = LoadRows(row.offset, lane);
  }
  for (; step != top; ++step) {
    const std::int32_t* const joints = step->joints.at + lane;
    const JointLanes joint = LoadJoint(pose.numbers, joints);
    position = WhereActive(*step, lane, Up(pose, joints, joint, position), position);
  }
  for (; step != end; ++step) {
    const std::int32_t* const joints = step->joints.at + lane;
    const JointLanes joint = LoadJoint(pose.numbers, joints);
    position = WhereActive(*step, lane, Down(pose, joints, joint, position), position);
  }
  return position;
}

// The coefficients at the places of each lane; 0 for places outside the list, such as -1. Scalar
// loads: the coefficients of a row come from unrelated places, and a stream may send fewer than the
// rig names.
HWY_INLINE Float LoadCoefficients(std::span<const float> coefficients, const IntRow& places,
                                  std::size_t lane) {
  HWY_ALIGN float loaded[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const auto place = static_cast<std::size_t>(places.at[lane + i]);
    loaded[i] = place < coefficients.size() ? coefficients[place] : 0.0f;
  }
  return LoadLanes(loaded);
}

// Four points with the same joints. Each joint is loaded once.
struct FourPoints {
  Float3 at[4];
};
template <bool kScaled>
FourPoints EvaluateFour(const PointPlan& plan, const PointRow* rows, LanePose<kScaled> pose,
                        std::size_t lane) {
  FourPoints points;
  for (std::size_t i = 0; i < 4; ++i) points.at[i] = LoadRows(rows[i].offset, lane);
  const JointStep* step = plan.steps.data() + rows->first_step;
  for (int i = 0; i < rows->num_up + rows->num_down; ++i, ++step) {
    const std::int32_t* const joints = step->joints.at + lane;
    const JointLanes joint = LoadJoint(pose.numbers, joints);
    for (Float3& v : points.at) {
      // All four points have the chains of the first row; only their offsets differ.
      const bool is_up = i < rows->num_up;
      const Float3 moved = is_up ? Up(pose, joints, joint, v) : Down(pose, joints, joint, v);
      v = WhereActive(*step, lane, moved, v);
    }
  }
  return points;
}

// Calls `function(block, lane, to)` for each block that the level of detail reaches, `kLanes` lanes
// at a time. `to` points to the first lane of the block's first row.
template <class Block, class Function>
HWY_INLINE void ForEachBlock(const std::vector<Block>& blocks, std::size_t num_values, float* rows,
                             Function function) {
  for (const Block& block : blocks) {
    if (block.first_value >= num_values) continue;
    for (std::size_t lane = 0; lane < block.num_lanes; lane += kLanes) {
      function(block, lane, rows + block.first_row * kRowLanes + lane);
    }
  }
}

// Stores a vector to three rows.
HWY_INLINE void StoreRows(Float3 v, float* rows) {
  StoreLanes(v.x, rows);
  StoreLanes(v.y, rows + kRowLanes);
  StoreLanes(v.z, rows + 2 * kRowLanes);
}

// Point `index` of a lane, from the rows that the points of a block were stored to.
inline glm::vec3 StoredPoint(const SinglePoints& block, std::size_t lane, std::size_t index,
                             const float* rows) {
  const float* const at = rows + (block.first_row + 3 * index) * kRowLanes + lane;
  return {at[0], at[kRowLanes], at[2 * kRowLanes]};
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
