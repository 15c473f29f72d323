// SPDX-License-Identifier: Apache-2.0
// Checks all numbers of a pose before any is used.
#if defined(FURROW_WRINKLE_POSE_CHECK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_POSE_CHECK_INL_H_
#undef FURROW_WRINKLE_POSE_CHECK_INL_H_
#else
#define FURROW_WRINKLE_POSE_CHECK_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <span>

#include "wrinkle/simd/lane_points-inl.h"
#include "wrinkle/skeleton/finite.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Returns true if no number is NaN or infinite.
HWY_INLINE bool AllFiniteLanes(std::span<const float> numbers) {
  const Floats d;
  // 0 times NaN or infinity is NaN, and NaN stays in the sum.
  Float zero = hn::Zero(d);
  std::size_t i = 0;
  for (; i + kLanes <= numbers.size(); i += kLanes) {
    zero = hn::MulAdd(hn::LoadU(d, numbers.data() + i), hn::Zero(d), zero);
  }
  return hn::AllTrue(d, hn::Eq(zero, hn::Zero(d))) && AllFinite(numbers.subspan(i));
}

struct PoseCheck {
  bool is_finite;  // no number of the pose is NaN or infinite
  bool is_scaled;  // some scale is not exactly 1
};

HWY_INLINE PoseCheck CheckJoints(std::span<const Transform> joints) {
  bool is_scaled = false;
  for (const Transform& joint : joints) is_scaled = is_scaled || joint.scale != glm::vec3(1.0f);
  return {AllFinite(joints), is_scaled};
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE PoseCheck CheckPose(std::span<const Transform> joints) { return CheckJoints(joints); }

#else

// After five vectors, scales are in the same lanes again.
constexpr std::size_t kCheckVectors = 5;
constexpr std::size_t kCheckJoints = kCheckVectors * kLanes / kJointFloats;
static_assert(kCheckVectors * kLanes % kJointFloats == 0);

// kCheckJoints joints with scale 1 and all other numbers 0, and a mask of the lanes with scales.
struct alignas(kRowAlignment) UnscaledJoints {
  float ones[kCheckVectors * kLanes] = {};
  float is_scale[kCheckVectors * kLanes] = {};
};
constexpr UnscaledJoints MakeUnscaledJoints() {
  UnscaledJoints joints;
  for (std::size_t i = 0; i < kCheckVectors * kLanes; ++i) {
    if (i % kJointFloats < kScaleFloat) continue;
    joints.ones[i] = 1.0f;
    joints.is_scale[i] = std::bit_cast<float>(-1);
  }
  return joints;
}

// Sums the squared differences from unscaled joints. In lanes with scales, a sum of 0 means that
// all scales are 1. A finite total means that all numbers are finite. Finite numbers with squares
// beyond a float make it infinite too, so CheckJoints() decides then.
HWY_INLINE PoseCheck CheckPose(std::span<const Transform> joints) {
  if (joints.size() < kCheckJoints) return CheckJoints(joints);
  static constexpr UnscaledJoints kUnscaled = MakeUnscaledJoints();
  const Floats d;
  const float* numbers = &joints.front().translation.x;
  // Five sums, one per vector of a block, so that each lane of a sum always has the same kind of
  // number. They also run in parallel, because none waits for another.
  Float s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0;
  const auto add = [&](std::size_t i, Float* sum) HWY_ATTR {
    const Float v = hn::LoadU(d, numbers + i * kLanes);
    const Float off = hn::Sub(v, LoadLanes(kUnscaled.ones + i * kLanes));
    *sum = hn::MulAdd(off, off, *sum);
  };
  for (std::size_t left = joints.size(); left > 0;) {
    add(0, &s0);
    add(1, &s1);
    add(2, &s2);
    add(3, &s3);
    add(4, &s4);
    // The last block overlaps the one before it.
    left -= std::min(left, kCheckJoints);
    numbers += std::min(left, kCheckJoints) * kJointFloats;
  }
  const auto of_scale = [&](std::size_t i, Float sum) HWY_ATTR {
    return hn::And(sum, LoadLanes(kUnscaled.is_scale + i * kLanes));
  };
  const Float all = hn::Add(hn::Add(s0, s1), hn::Add(s2, hn::Add(s3, s4)));
  if (!hn::AllTrue(d, hn::Lt(all, hn::Inf(d)))) return CheckJoints(joints);
  const Float scale = hn::Or(hn::Or(of_scale(0, s0), of_scale(1, s1)),
                             hn::Or(of_scale(2, s2), hn::Or(of_scale(3, s3), of_scale(4, s4))));
  return {true, !hn::AllTrue(d, hn::Eq(scale, hn::Zero(d)))};
}

#endif

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
