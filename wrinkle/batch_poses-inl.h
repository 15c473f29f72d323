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

HWY_INLINE Moved ToDoubles(const Float3& v) {
  return {ToDoubles(v.x), ToDoubles(v.y), ToDoubles(v.z)};
}

HWY_INLINE Double MulAddDot(const glm::dvec3& d, Double x, Double y, Double z, Double sum) {
  const HalfDoubles doubles;
  sum = hn::MulAdd(x, hn::Set(doubles, d.x), sum);
  sum = hn::MulAdd(y, hn::Set(doubles, d.y), sum);
  return hn::MulAdd(z, hn::Set(doubles, d.z), sum);
}

// ProjectionAlong().
HWY_INLINE Float Along(const Moved* moved, const glm::dvec3* projection, std::size_t num_points) {
  Doubles sum = {hn::Zero(HalfDoubles()), hn::Zero(HalfDoubles())};
  for (std::size_t i = 0; i < num_points; ++i) {
    const Moved& m = moved[i];
    sum.low = MulAddDot(projection[i], m.x.low, m.y.low, m.z.low, sum.low);
    sum.high = MulAddDot(projection[i], m.x.high, m.y.high, m.z.high, sum.high);
  }
  return ToFloats(sum);
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

HWY_INLINE Moved Measure(const PoseDriverSet::Measured& point, const JointChains& chains,
                         PoseLanes* lanes) {
  const Float3 position = EvaluatePoint(chains.chain(point.point), lanes);
  return ToDoubles(position - Splat(point.rest));
}

// Any number of points. `moved` has room for them.
HWY_INLINE void StorePoseValues(const PoseDriverSet& drivers, std::size_t index, const Moved* moved,
                                std::size_t num_points, float* values) {
  const PoseDriverSet::Entry& entry = drivers.entries()[index];
  const glm::dvec3* projection = drivers.projections(entry);
  for (int k = 0; k < entry.num_values; ++k, projection += num_points) {
    const Float along = Along(moved, projection, num_points);
    Float value = Saturate(along);
    if (entry.falloff > 0.0f) {
      const int driver = static_cast<int>(index);
      const float square = drivers.SquaredDisplacement(driver, k);
      const auto displacement = drivers.Displacement(driver, k);
      // Where the pose does not move the points, `along` is 0 and the width does not count.
      const Float share =
          LaneFalloff(moved, displacement, along, square > 0.0f ? square : 1.0f, entry.falloff);
      value = Saturate(hn::Mul(value, share));
    }
    StoreLanes(value, values + static_cast<std::size_t>(k) * kLanes);
  }
}

inline void EvaluatePose(const PoseDriverSet& drivers, std::size_t index, const JointChains& chains,
                         PoseLanes* lanes, float* values) {
  const auto points = drivers.points(drivers.entries()[index]);
  if (points.size() == 1) {  // the most of them: it then stays in registers
    const Moved moved = Measure(points[0], chains, lanes);
    StorePoseValues(drivers, index, &moved, 1, values);
    return;
  }
  Moved moved[kMaxControlPoints];
  for (std::size_t i = 0; i < points.size(); ++i) moved[i] = Measure(points[i], chains, lanes);
  StorePoseValues(drivers, index, moved, points.size(), values);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
