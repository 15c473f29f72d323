// SPDX-License-Identifier: Apache-2.0
// Vectors of floats, one driver or weight per SIMD lane. Compiled once per instruction set
// (solver/subject_kernel.cpp).
//
// The vector operations below never fuse a product with a sum, and follow the order that GLM uses.
// Points therefore have the same bits as JointChains::Evaluate(), with every instruction set.
#if defined(FURROW_WRINKLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_LANES_INL_H_
#undef FURROW_WRINKLE_LANES_INL_H_
#else
#define FURROW_WRINKLE_LANES_INL_H_
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/simd/row_gather.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// At most as many lanes as a row has. With fewer lanes, a row takes several turns.
#if HWY_TARGET == HWY_SCALAR  // processors without SSE4, for which there are no shuffles
using Floats = hn::CappedTag<float, 1>;
constexpr std::size_t kLanes = 1;
#else
using Floats = hn::CappedTag<float, kRowLanes>;
constexpr std::size_t kLanes = HWY_MIN(HWY_MAX_BYTES / sizeof(float), kRowLanes);
#endif
using Float = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

// A component per vector (structure of arrays): every operation works on all lanes, without
// shuffles.
struct Float3 {
  Float x, y, z;
};
struct FloatQuat {
  Float x, y, z, w;
};
HWY_INLINE Float Splat(float x) { return hn::Set(Floats(), x); }
HWY_INLINE Float LoadLanes(const float* from) { return hn::Load(Floats(), from); }
HWY_INLINE void StoreLanes(Float v, float* to) { hn::Store(v, Floats(), to); }
// The lanes of a row that this turn covers; `lane` is the first.
HWY_INLINE Float LoadRow(const FloatRow& row, std::size_t lane) { return LoadLanes(row.at + lane); }
HWY_INLINE Float3 LoadRows(const FloatRow* rows, std::size_t lane) {
  return {LoadRow(rows[0], lane), LoadRow(rows[1], lane), LoadRow(rows[2], lane)};
}
HWY_INLINE Mask LoadMask(const IntRow& row, std::size_t lane) {
  const hn::RebindToSigned<Floats> ints;
  const auto set = hn::Ne(hn::Load(ints, row.at + lane), hn::Zero(ints));
  return hn::RebindMask(Floats(), set);
}

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

// `x` clamped to [0, 1]; 0 for a NaN (base/scalar.h).
HWY_INLINE Float Saturate(Float x) {
  return hn::IfThenElseZero(hn::Gt(x, hn::Zero(Floats())), hn::Min(x, Splat(1.0f)));
}

// Saturate() for numbers that are not NaN, computed on their bits: as integers, non-negative floats
// keep their order and negative floats stay negative. This leaves the floating-point units free.
HWY_INLINE Float SaturateNumber(Float x) {
  const hn::RebindToSigned<Floats> ints;
  const auto least = hn::Max(hn::BitCast(ints, x), hn::Zero(ints));
  return hn::BitCast(Floats(), hn::Min(least, hn::BitCast(ints, Splat(1.0f))));
}

// base/scalar.h's Smoothstep() per lane.
HWY_INLINE Float Smoothstep(float from, float to, Float x) {
  const Float t = Saturate(hn::Div(hn::Sub(x, Splat(from)), Splat(to - from)));
  return hn::Mul(hn::Mul(t, t), hn::NegMulAdd(Splat(2.0f), t, Splat(3.0f)));
}

HWY_INLINE Float3 IfThenElse(Mask mask, Float3 yes, Float3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

// Four numbers per lane, one vector each. Compilers would keep an array in memory.
struct Columns {
  Float c0, c1, c2, c3;
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE Columns LoadColumns(const float* numbers, const std::int32_t* places) {
  const float* const from = numbers + places[0];
  return {Splat(from[0]), Splat(from[1]), Splat(from[2]), Splat(from[3])};
}

#else

// Transposes four vectors within each block of four lanes.
HWY_INLINE Columns Transpose(Columns in) {
  // Two rounds of interleaving. The first pairs vectors 0 with 2 and 1 with 3; the second then
  // restores the order of the lanes.
  const Floats d;
  const Float low02 = hn::InterleaveLower(d, in.c0, in.c2);
  const Float high02 = hn::InterleaveUpper(d, in.c0, in.c2);
  const Float low13 = hn::InterleaveLower(d, in.c1, in.c3);
  const Float high13 = hn::InterleaveUpper(d, in.c1, in.c3);
  return {hn::InterleaveLower(d, low02, low13), hn::InterleaveUpper(d, low02, low13),
          hn::InterleaveLower(d, high02, high13), hn::InterleaveUpper(d, high02, high13)};
}

// Four numbers at `places[first]` and at every fourth place after it.
template <std::size_t kN>
HWY_INLINE hn::Vec<hn::FixedTag<float, kN>> LoadFours(const float* numbers,
                                                      const std::int32_t* places,
                                                      std::size_t first) {
  // Block b of the vector holds the numbers of place first + 4 b. A transposition within blocks of
  // 128 bits, which every instruction set has, then leaves the lanes in order.
  const hn::FixedTag<float, kN> lanes;
  if constexpr (kN == 4) {
    return hn::LoadU(lanes, numbers + places[first]);
  } else {
    return hn::Combine(lanes, LoadFours<kN / 2>(numbers, places, first + kN / 2),
                       LoadFours<kN / 2>(numbers, places, first));
  }
}

// Loads the four numbers that begin at each lane's place.
HWY_INLINE Columns LoadColumns(const float* numbers, const std::int32_t* places) {
  return Transpose({LoadFours<kLanes>(numbers, places, 0), LoadFours<kLanes>(numbers, places, 1),
                    LoadFours<kLanes>(numbers, places, 2), LoadFours<kLanes>(numbers, places, 3)});
}

#endif  // HWY_SCALAR

// Eight consecutive numbers per lane.
struct TwoColumns {
  Columns begin, end;
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE TwoColumns LoadTwoColumns(const float* numbers, const std::int32_t* places) {
  return {LoadColumns(numbers, places), LoadColumns(numbers + 4, places)};
}

#elif HWY_MAX_BYTES >= 64

// Loads all eight numbers of a place at once, those of two places per vector.
HWY_INLINE TwoColumns LoadTwoColumns(const float* numbers, const std::int32_t* places) {
  const auto pair = [=](std::size_t lane) HWY_ATTR {
    const hn::FixedTag<float, 8> eight;
    return hn::Combine(Floats(), hn::LoadU(eight, numbers + places[lane + 4]),
                       hn::LoadU(eight, numbers + places[lane]));
  };
  // Blocks of four lanes: the first and second four numbers of places 0 to 3, then those of places
  // 4 to 7. `high` has the same of places 8 to 15.
  const Columns low = Transpose({pair(0), pair(1), pair(2), pair(3)});
  const Columns high = Transpose({pair(8), pair(9), pair(10), pair(11)});
  const auto first = [](Float a, Float b) HWY_ATTR {
    return Float{_mm512_shuffle_f32x4(a.raw, b.raw, _MM_SHUFFLE(2, 0, 2, 0))};
  };
  const auto second = [](Float a, Float b) HWY_ATTR {
    return Float{_mm512_shuffle_f32x4(a.raw, b.raw, _MM_SHUFFLE(3, 1, 3, 1))};
  };
  return {{first(low.c0, high.c0), first(low.c1, high.c1), first(low.c2, high.c2),
           first(low.c3, high.c3)},
          {second(low.c0, high.c0), second(low.c1, high.c1), second(low.c2, high.c2),
           second(low.c3, high.c3)}};
}

#else

// Loads row by row, so that few places occupy registers at a time.
HWY_INLINE TwoColumns LoadTwoColumns(const float* numbers, const std::int32_t* places) {
  const float* const next = numbers + 4;
  const Float b0 = LoadFours<kLanes>(numbers, places, 0);
  const Float e0 = LoadFours<kLanes>(next, places, 0);
  const Float b1 = LoadFours<kLanes>(numbers, places, 1);
  const Float e1 = LoadFours<kLanes>(next, places, 1);
  const Float b2 = LoadFours<kLanes>(numbers, places, 2);
  const Float e2 = LoadFours<kLanes>(next, places, 2);
  const Float b3 = LoadFours<kLanes>(numbers, places, 3);
  const Float e3 = LoadFours<kLanes>(next, places, 3);
  return {Transpose({b0, b1, b2, b3}), Transpose({e0, e1, e2, e3})};
}

#endif

// Performs a RowGather. The pointers to its tables are copied once: a compiler must assume that a
// stored vector changes a pointer in memory, and would load the pointers again and again.
#if HWY_MAX_BYTES >= 32

class Gatherer {
 public:
  HWY_INLINE explicit Gatherer(const RowGather& gather)
      : first_(gather.first_steps()), more_(gather.more()) {}

  // The lanes from `lane` on of output row `row`.
  HWY_INLINE Float Row(std::size_t row, std::size_t lane, const float* list) const {
    const RowGather::Step& first = first_[row];
    Float out = Take(first, hn::Load(Ints(), first.lanes.at + lane), list);
    return first.num_more == 0 ? out : More(first, lane, list, out);
  }

 private:
  using Ints = hn::RebindToSigned<Floats>;
  using Int = hn::Vec<Ints>;

  // Adds the lanes that come from further pairs of rows. A negative code marks a lane that another
  // step fills.
  HWY_INLINE Float More(const RowGather::Step& first, std::size_t lane, const float* list,
                        Float out) const {
    const RowGather::Step* step = more_ + first.first_more;
    for (const RowGather::Step* const end = step + first.num_more; step != end; ++step) {
      const auto from = hn::Load(Ints(), step->lanes.at + lane);
      const auto others = hn::RebindMask(Floats(), hn::Lt(from, hn::Zero(Ints())));
      out = hn::IfThenElse(others, out, Take(*step, from, list));
    }
    return out;
  }

#if HWY_MAX_BYTES >= 64

  // The codes of a step are this instruction's indices: bits 0 to 3 select the lane, bit 4 selects
  // the second row.
  static HWY_INLINE Float Take(const RowGather::Step& step, Int from, const float* list) {
    const Float first = LoadLanes(list + step.first);
    const Float second = LoadLanes(list + step.second);
    return Float{_mm512_permutex2var_ps(first.raw, from.raw, second.raw)};
  }

#else

  // With eight lanes, a row is two vectors. In a step's code, bits 0 to 2 select the lane, bit 3
  // the half of the row, bit 4 the second row.
  static HWY_INLINE Float Take(const RowGather::Step& step, Int from, const float* list) {
    const Float first = TakeRow(list + step.first, from);
    const Float second = TakeRow(list + step.second, from);
    return hn::IfThenElse(HasBit(from, kRowLanes), second, first);
  }

  static HWY_INLINE Float TakeRow(const float* row, Int from) {
    const auto lanes = hn::IndicesFromVec(Floats(), hn::And(from, hn::Set(Ints(), kLanes - 1)));
    const Float low = hn::TableLookupLanes(LoadLanes(row), lanes);
    const Float high = hn::TableLookupLanes(LoadLanes(row + kLanes), lanes);
    return hn::IfThenElse(HasBit(from, kLanes), high, low);
  }

  static HWY_INLINE Mask HasBit(Int v, std::size_t bit) {
    const auto set = hn::And(v, hn::Set(Ints(), static_cast<std::int32_t>(bit)));
    return hn::RebindMask(Floats(), hn::Ne(set, hn::Zero(Ints())));
  }

#endif

  const RowGather::Step* first_;
  const RowGather::Step* more_;
};

#else  // short vectors, for which shuffles gain nothing

class Gatherer {
 public:
  HWY_INLINE explicit Gatherer(const RowGather& gather) : places_(gather.indices()) {}

  // The lanes from `lane` on of output row `row`.
  HWY_INLINE Float Row(std::size_t row, std::size_t lane, const float* list) const {
    const std::uint32_t* const places = places_ + row * kRowLanes + lane;
    HWY_ALIGN float numbers[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) numbers[i] = list[places[i]];
    return LoadLanes(numbers);
  }

 private:
  const std::uint32_t* places_;
};

#endif

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
