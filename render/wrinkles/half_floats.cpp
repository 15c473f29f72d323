// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set and chosen at run time: Highway includes this file repeatedly.
// Vectors of unknown size (SVE, RVV) are disabled, as in render/compose/compose_job.cpp.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/wrinkles/half_floats.cpp"
#include "render/wrinkles/half_floats.h"

#include <algorithm>
#include <array>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace furrow::render::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Halves = hn::Rebind<hwy::float16_t, Floats>;

void EncodeVector(const float* from, std::uint16_t* to) {
  hn::StoreU(hn::DemoteTo(Halves(), hn::LoadU(Floats(), from)), Halves(),
             reinterpret_cast<hwy::float16_t*>(to));
}

void DecodeVector(const std::uint16_t* from, float* to) {
  hn::StoreU(
      hn::PromoteTo(Floats(), hn::LoadU(Halves(), reinterpret_cast<const hwy::float16_t*>(from))),
      Floats(), to);
}

// Calls `convert` for whole vectors, and for the rest in a copy that fills one.
template <class From, class To, class Convert>
HWY_INLINE void ConvertAll(const From* from, To* to, std::size_t count, Convert convert) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) convert(from + i, to + i);
  std::array<From, 16> last_from{};
  std::array<To, 16> last_to{};
  std::copy(from + i, from + count, last_from.begin());
  convert(last_from.data(), last_to.data());
  std::copy_n(last_to.begin(), count - i, to + i);
}

void EncodeAll(const float* from, std::uint16_t* to, std::size_t count) {
  ConvertAll(from, to, count, EncodeVector);
}

void DecodeAll(const std::uint16_t* from, float* to, std::size_t count) {
  ConvertAll(from, to, count, DecodeVector);
}

}  // namespace furrow::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace furrow::render {
namespace {

HWY_EXPORT(EncodeAll);
HWY_EXPORT(DecodeAll);

}  // namespace

void ToHalfFloats(std::span<const float> from, std::span<std::uint16_t> to) {
  HWY_DYNAMIC_DISPATCH(EncodeAll)(from.data(), to.data(), std::min(from.size(), to.size()));
}

void FromHalfFloats(std::span<const std::uint16_t> from, std::span<float> to) {
  HWY_DYNAMIC_DISPATCH(DecodeAll)(from.data(), to.data(), std::min(from.size(), to.size()));
}

}  // namespace furrow::render
#endif  // HWY_ONCE
