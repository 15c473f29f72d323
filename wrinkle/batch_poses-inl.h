// SPDX-License-Identifier: Apache-2.0
// Pose drivers of several subjects side by side: pose_projection.h, lane by lane.
#if defined(FURROW_WRINKLE_BATCH_POSES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_POSES_INL_H_
#undef FURROW_WRINKLE_BATCH_POSES_INL_H_
#else
#define FURROW_WRINKLE_BATCH_POSES_INL_H_
#endif

#include "wrinkle/batch_drivers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// A control point's departure from rest. In double, as what it is multiplied by: where a point
// moves far across a small displacement, floats would leave too little of the projection.
struct Moved {
  Doubles x, y, z;
};

HWY_INLINE Moved Measure(const PoseDriverSet::Measured& point, const JointChains& chains,
                         PoseLanes* lanes) {
  const Float3 moved = EvaluatePoint(chains.chain(point.point), lanes) - Splat(point.rest);
  return {ToDoubles(moved.x), ToDoubles(moved.y), ToDoubles(moved.z)};
}

// sum + dot(moved, projection).
HWY_INLINE Doubles AddDot(Moved moved, const glm::dvec3& projection, Doubles sum) {
  const HalfDoubles d;
  const Double x = hn::Set(d, projection.x);
  const Double y = hn::Set(d, projection.y);
  const Double z = hn::Set(d, projection.z);
  sum.low = hn::MulAdd(moved.x.low, x, sum.low);
  sum.high = hn::MulAdd(moved.x.high, x, sum.high);
  sum.low = hn::MulAdd(moved.y.low, y, sum.low);
  sum.high = hn::MulAdd(moved.y.high, y, sum.high);
  sum.low = hn::MulAdd(moved.z.low, z, sum.low);
  sum.high = hn::MulAdd(moved.z.high, z, sum.high);
  return sum;
}

HWY_INLINE Doubles ZeroDoubles() { return {hn::Zero(HalfDoubles()), hn::Zero(HalfDoubles())}; }

// One point, no falloff: the most of them, so all stays in registers.
inline void EvaluateOnePoint(const PoseDriverSet& drivers, const PoseDriverSet::Entry& entry,
                             const JointChains& chains, PoseLanes* lanes, float* values) {
  const Moved moved = Measure(drivers.points(entry)[0], chains, lanes);
  const glm::dvec3* projection = drivers.projections(entry);
  for (const glm::dvec3* const end = projection + entry.num_values; projection != end;
       ++projection, values += kLanes) {
    StoreLanes(Saturate(ToFloats(AddDot(moved, *projection, ZeroDoubles()))), values);
  }
}

// Falloff() of SquaredDistance().
inline Float LaneFalloff(const Moved* moved, std::span<const glm::vec3> displacement, Float along,
                         float squared_displacement, float falloff) {
  Float sum = hn::Zero(Floats());
  for (std::size_t i = 0; i < displacement.size(); ++i) {
    const Moved& m = moved[i];
    const Float3 point{ToFloats(m.x), ToFloats(m.y), ToFloats(m.z)};
    const Float3 difference = point - along * Splat(displacement[i]);
    sum = hn::Add(sum, Dot(difference, difference));
  }
  const float width = 2.0f * falloff * falloff * squared_displacement;
  return Exponential(hn::Div(hn::Neg(sum), Splat(width)));
}

inline void EvaluatePoints(const PoseDriverSet& drivers, const PoseDriverSet::Entry& entry,
                           const JointChains& chains, PoseLanes* lanes, float* values) {
  const auto points = drivers.points(entry);
  Moved moved[kMaxControlPoints];
  for (std::size_t i = 0; i < points.size(); ++i) moved[i] = Measure(points[i], chains, lanes);
  const glm::dvec3* projection = drivers.projections(entry);
  for (int k = 0; k < entry.num_values; ++k, values += kLanes) {
    Doubles sum = ZeroDoubles();
    for (std::size_t i = 0; i < points.size(); ++i) sum = AddDot(moved[i], *projection++, sum);
    const Float along = ToFloats(sum);
    Float value = Saturate(along);
    if (entry.falloff > 0.0f) {
      const int driver = static_cast<int>(&entry - drivers.entries().data());
      const float square = drivers.SquaredDisplacement(driver, k);
      // Where the pose does not move the points, `along` is 0 and the width does not count.
      const Float share = LaneFalloff(moved, drivers.Displacement(driver, k), along,
                                      square > 0.0f ? square : 1.0f, entry.falloff);
      value = Saturate(hn::Mul(value, share));
    }
    StoreLanes(value, values);
  }
}

inline void EvaluatePose(const PoseDriverSet& drivers, const PoseDriverSet::Entry& entry,
                         const JointChains& chains, PoseLanes* lanes, float* values) {
  if (entry.num_points == 1 && !(entry.falloff > 0.0f)) {
    EvaluateOnePoint(drivers, entry, chains, lanes, values);
  } else {
    EvaluatePoints(drivers, entry, chains, lanes, values);
  }
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
