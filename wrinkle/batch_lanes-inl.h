// SPDX-License-Identifier: Apache-2.0
// Numbers of several subjects side by side, one a SIMD lane, compiled once for each instruction set
// (batch_kernel.cpp). Multiplications and additions are kept apart, in the order in which GLM does
// them, so that points come out as in the scalar solver, bit by bit.
#if defined(FURROW_WRINKLE_BATCH_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_LANES_INL_H_
#undef FURROW_WRINKLE_BATCH_LANES_INL_H_
#else
#define FURROW_WRINKLE_BATCH_LANES_INL_H_
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "wrinkle/batch_kernel.h"
#include "wrinkle/transform.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kMaxBatchLanes>;
using Float = hn::Vec<Floats>;
#if HWY_TARGET == HWY_SCALAR  // processors without SSE4: one lane, for which there are no shuffles
using HalfDoubles = hn::CappedTag<double, 1>;
constexpr std::size_t kLanes = 1;
#else
using HalfDoubles = hn::Repartition<double, Floats>;  // as wide; two of them hold all lanes
constexpr std::size_t kLanes = HWY_MIN(HWY_MAX_BYTES / sizeof(float), kMaxBatchLanes);
#endif
using Double = hn::Vec<HalfDoubles>;

struct Float3 {
  Float x, y, z;
};
struct FloatQuat {
  Float x, y, z, w;
};
// As many doubles as there are lanes.
struct Doubles {
  Double low, high;
};

HWY_INLINE Float Splat(float x) { return hn::Set(Floats(), x); }
HWY_INLINE Float3 Splat(const glm::vec3& v) { return {Splat(v.x), Splat(v.y), Splat(v.z)}; }
HWY_INLINE Float LoadLanes(const float* from) { return hn::Load(Floats(), from); }
HWY_INLINE void StoreLanes(Float v, float* to) { hn::Store(v, Floats(), to); }

HWY_INLINE Float3 operator+(Float3 a, Float3 b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Float3 operator-(Float3 a, Float3 b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Float3 operator*(Float3 a, Float3 b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
HWY_INLINE Float3 operator/(Float3 a, Float3 b) {
  return {hn::Div(a.x, b.x), hn::Div(a.y, b.y), hn::Div(a.z, b.z)};
}
HWY_INLINE Float3 operator*(Float s, Float3 v) { return Float3{s, s, s} * v; }

HWY_INLINE Float Dot(Float3 a, Float3 b) {
  const Float3 p = a * b;
  return hn::Add(hn::Add(p.x, p.y), p.z);
}

HWY_INLINE Float3 Cross(Float3 a, Float3 b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

// The rotated vector; glm's quat * vec3.
HWY_INLINE Float3 Rotate(FloatQuat q, Float3 v) {
  const Float3 axis{q.x, q.y, q.z};
  const Float3 uv = Cross(axis, v);
  const Float3 uuv = Cross(axis, uv);
  const Float3 sum = q.w * uv + uuv;
  return v + (sum + sum);
}

HWY_INLINE FloatQuat Conjugate(FloatQuat q) {
  return {hn::Neg(q.x), hn::Neg(q.y), hn::Neg(q.z), q.w};
}

// `x` clamped to [0, 1], 0 for a NaN (scalar.h).
HWY_INLINE Float Saturate(Float x) {
  return hn::IfThenElseZero(hn::Gt(x, hn::Zero(Floats())), hn::Min(x, Splat(1.0f)));
}

HWY_INLINE Float Smoothstep(float from, float to, Float x) {
  const Float t = Saturate(hn::Div(hn::Sub(x, Splat(from)), Splat(to - from)));
  return hn::Mul(hn::Mul(t, t), hn::NegMulAdd(Splat(2.0f), t, Splat(3.0f)));
}

// Four numbers of each subject, one vector each. No array: compilers keep those in memory.
struct Columns {
  Float c0, c1, c2, c3;
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE Doubles ToDoubles(Float v) {
  return {hn::PromoteTo(HalfDoubles(), v), hn::Zero(HalfDoubles())};
}

HWY_INLINE Float ToFloats(Doubles v) { return hn::DemoteTo(Floats(), v.low); }

HWY_INLINE Columns LoadColumns(const float* const* subjects, std::size_t offset) {
  const float* const from = subjects[0] + offset;
  return {Splat(from[0]), Splat(from[1]), Splat(from[2]), Splat(from[3])};
}

HWY_INLINE void StoreColumns(Columns columns, float* const* subjects, std::size_t offset) {
  float* const to = subjects[0] + offset;
  to[0] = hn::GetLane(columns.c0);
  to[1] = hn::GetLane(columns.c1);
  to[2] = hn::GetLane(columns.c2);
  to[3] = hn::GetLane(columns.c3);
}

#else

HWY_INLINE Doubles ToDoubles(Float v) {
  const hn::Half<Floats> half;
  const HalfDoubles doubles;
  return {hn::PromoteTo(doubles, hn::LowerHalf(half, v)),
          hn::PromoteTo(doubles, hn::UpperHalf(half, v))};
}

HWY_INLINE Float ToFloats(Doubles v) {
  const hn::Half<Floats> half;
  return hn::Combine(Floats(), hn::DemoteTo(half, v.high), hn::DemoteTo(half, v.low));
}

// Four vectors to their transpose within each block of four lanes. What was loaded by LoadRow()
// becomes columns, and back again.
HWY_INLINE Columns Transpose(Columns in) {
  const Floats d;
  const Float low02 = hn::InterleaveLower(d, in.c0, in.c2);
  const Float high02 = hn::InterleaveUpper(d, in.c0, in.c2);
  const Float low13 = hn::InterleaveLower(d, in.c1, in.c3);
  const Float high13 = hn::InterleaveUpper(d, in.c1, in.c3);
  return {hn::InterleaveLower(d, low02, low13), hn::InterleaveUpper(d, low02, low13),
          hn::InterleaveLower(d, high02, high13), hn::InterleaveUpper(d, high02, high13)};
}

// A row of kN lanes: of subject `first` and every fourth after it, four numbers at `offset` in each
// one's list.
template <std::size_t kN>
HWY_INLINE hn::Vec<hn::FixedTag<float, kN>> LoadRow(const float* const* subjects, std::size_t first,
                                                    std::size_t offset) {
  const hn::FixedTag<float, kN> lanes;
  if constexpr (kN == 4) {
    return hn::LoadU(lanes, subjects[first] + offset);
  } else {
    return hn::Combine(lanes, LoadRow<kN / 2>(subjects, first + kN / 2, offset),
                       LoadRow<kN / 2>(subjects, first, offset));
  }
}

template <std::size_t kN>
HWY_INLINE void StoreRow(hn::Vec<hn::FixedTag<float, kN>> row, float* const* subjects,
                         std::size_t first, std::size_t offset) {
  if constexpr (kN == 4) {
    hn::StoreU(row, hn::FixedTag<float, kN>(), subjects[first] + offset);
  } else {
    const hn::FixedTag<float, kN / 2> half;
    StoreRow<kN / 2>(hn::LowerHalf(half, row), subjects, first, offset);
    StoreRow<kN / 2>(hn::UpperHalf(half, row), subjects, first + kN / 2, offset);
  }
}

// Numbers `offset` to `offset` + 3 of every subject.
HWY_INLINE Columns LoadColumns(const float* const* subjects, std::size_t offset) {
  return Transpose({LoadRow<kLanes>(subjects, 0, offset), LoadRow<kLanes>(subjects, 1, offset),
                    LoadRow<kLanes>(subjects, 2, offset), LoadRow<kLanes>(subjects, 3, offset)});
}

HWY_INLINE void StoreColumns(Columns columns, float* const* subjects, std::size_t offset) {
  const Columns rows = Transpose(columns);
  StoreRow<kLanes>(rows.c0, subjects, 0, offset);
  StoreRow<kLanes>(rows.c1, subjects, 1, offset);
  StoreRow<kLanes>(rows.c2, subjects, 2, offset);
  StoreRow<kLanes>(rows.c3, subjects, 3, offset);
}

#endif  // HWY_SCALAR

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
