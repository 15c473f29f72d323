// SPDX-License-Identifier: Apache-2.0
// Transcendental functions for drivers and weights, accurate to about 1e-7 on the stated ranges.
#if defined(FURROW_WRINKLE_LANE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_LANE_MATH_INL_H_
#undef FURROW_WRINKLE_LANE_MATH_INL_H_
#else
#define FURROW_WRINKLE_LANE_MATH_INL_H_
#endif

#include "wrinkle/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Horner's scheme; the coefficient of the highest power comes first.
template <class... Rest>
HWY_INLINE Float Polynomial(Float x, float first, Rest... rest) {
  Float sum = Splat(first);
  ((sum = hn::MulAdd(sum, x, Splat(rest))), ...);
  return sum;
}

// atan2(y, x) in radians, for x >= 0; 0 if both are 0. The argument is folded to [0, tan(pi/8)], on
// which Cephes' polynomial is accurate to 1e-8.
HWY_INLINE Float ArcTangent(Float y, Float x) {
  const Floats d;
  const Float size = hn::Abs(y);
  const Float small = hn::Min(size, x);
  const Float large = hn::Max(size, x);
  // atan(s / l) = pi/4 + atan((s - l) / (s + l)) beyond tan(pi/8).
  const auto beyond = hn::Gt(small, hn::Mul(large, Splat(0.41421356f)));
  const Float over = hn::IfThenElse(beyond, hn::Sub(small, large), small);
  const Float under = hn::IfThenElse(beyond, hn::Add(small, large), large);
  const Float t = hn::IfThenElseZero(hn::Gt(under, hn::Zero(d)), hn::Div(over, under));
  const Float z = hn::Mul(t, t);
  const Float p =
      Polynomial(z, 8.05374449538e-2f, -1.38776856032e-1f, 1.99777106478e-1f, -3.33329491539e-1f);
  Float angle = hn::MulAdd(hn::Mul(p, z), t, t);
  angle = hn::Add(angle, hn::IfThenElseZero(beyond, Splat(0.785398163f)));
  angle = hn::IfThenElse(hn::Gt(size, x), hn::Sub(Splat(1.57079633f), angle), angle);
  return hn::CopySign(angle, y);
}

// exp(-x) for x in [0, 87] in two parts: 2^-n (1 + m), with m near 0 (Cephes).
struct ExponentialParts {
  Float power, m;
};
HWY_INLINE ExponentialParts SplitExponential(Float x) {
  const hn::RebindToSigned<Floats> ints;
  // Adding 1.5 * 2^23 rounds to an integer and leaves that integer in the lowest bits: conversions
  // would take several instructions more.
  const Float magic = Splat(12582912.0f);
  const Float rounded = hn::Add(hn::Mul(x, Splat(1.44269504f)), magic);
  const Float n = hn::Sub(rounded, magic);
  // ln 2 in two parts, so that the remainder keeps all its digits.
  const Float r = hn::MulAdd(n, Splat(-2.12194440e-4f), hn::MulSub(n, Splat(0.693359375f), x));
  const Float p = Polynomial(r, 1.9875691500e-4f, 1.3981999507e-3f, 8.3334519073e-3f,
                             4.1665795894e-2f, 1.6666665459e-1f, 5.0000001201e-1f);
  // n is at most 126, so 127 - n is the biased exponent of a normal float. The shift drops the bits
  // of the added number.
  const auto exponent =
      hn::Sub(hn::Set(ints, 127 << 23), hn::ShiftLeft<23>(hn::BitCast(ints, rounded)));
  return {hn::BitCast(Floats(), exponent), hn::MulAdd(p, hn::Mul(r, r), r)};
}

// exp(-x) for x >= 0; 0 below the smallest normal number.
HWY_INLINE Float NegativeExponential(Float x) {
  const ExponentialParts parts = SplitExponential(hn::Min(x, Splat(87.0f)));
  return hn::IfThenElseZero(hn::Le(x, Splat(87.0f)),
                            hn::Mul(hn::Add(parts.m, Splat(1.0f)), parts.power));
}

// 1 - exp(-x) for x >= 0, with a small relative error near 0 as well.
HWY_INLINE Float OneMinusExponential(Float x) {
  const ExponentialParts parts = SplitExponential(hn::Min(x, Splat(87.0f)));
  return hn::NegMulAdd(parts.power, parts.m, hn::Sub(Splat(1.0f), parts.power));
}

// (1 - cos(pi x)) / 2 = sin(pi x / 2)^2 for x in [0, 1]. Coefficients: Hastings, Approximations for
// Digital Computers (1955), sheet 16.
HWY_INLINE Float CosineCurve(Float x) {
  const Float z = hn::Mul(x, x);
  const Float sine = hn::Mul(x, Polynomial(z, 1.5148419e-4f, -4.67376557e-3f, 7.968967928e-2f,
                                           -6.4596371106e-1f, 1.57079631847f));
  return hn::Min(hn::Mul(sine, sine), Splat(1.0f));
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
