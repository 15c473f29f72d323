// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set and chosen at run time: Highway includes this file repeatedly.
// Vectors of unknown size (SVE, RVV) are disabled, because their types cannot be stored in arrays.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/compose/compose_job.cpp"
#include "render/compose/compose_job.h"

#include <algorithm>
#include <array>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace furrow::render::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Float = hn::Vec<Floats>;
using Halves = hn::Rebind<hwy::float16_t, Floats>;
using Words = hn::Rebind<std::uint16_t, Floats>;
using Bytes = hn::Rebind<std::uint8_t, Floats>;
using Ints = hn::Rebind<std::int32_t, Floats>;

constexpr std::size_t kPlane = ComposeTile::kTexels;
constexpr std::size_t kBlock = 256;  // texels per block; its planes fit the first-level cache
static_assert(kPlane % kBlock == 0);
using Numbers = std::array<float, kBlock>;

// Half floats stay 16-bit words in memory, because C++20 has no type for them.
HWY_INLINE Float LoadHalves(const std::uint16_t* from) {
  return hn::PromoteTo(Floats(),
                       hn::LoadU(Halves(), reinterpret_cast<const hwy::float16_t*>(from)));
}

HWY_INLINE hn::Vec<Words> ToHalves(Float v) {
  return hn::BitCast(Words(), hn::DemoteTo(Halves(), v));
}

HWY_INLINE hn::Vec<Words> ToHalves(const float* from) {
  return ToHalves(hn::LoadU(Floats(), from));
}

// Calls `visit` with the index of the first lane of every vector in a block.
template <class Visit>
HWY_INLINE void ForLanes(Visit visit) {
  for (std::size_t i = 0; i < kBlock; i += hn::Lanes(Floats())) visit(i);
}

// Adds weight * mask for one map in the block that starts at texel `first`. False: all weights are
// 0.
bool AddMasks(const ComposeJob& job, const std::vector<ComposeTile::Mask>& masks, std::size_t map,
              std::size_t first, Numbers* sums) {
  const std::size_t maps = job.tile->maps.size();
  bool is_at_work = false;
  for (const ComposeTile::Mask& mask : masks) {
    const float weight = job.strengths->weights[mask.channel * maps + map];
    if (!(weight > 0.0f)) continue;
    const Float scale = hn::Set(Floats(), weight / 255.0f);
    ForLanes([&](std::size_t i) HWY_ATTR {
      const auto bytes = hn::PromoteTo(Ints(), hn::LoadU(Bytes(), &mask.values[first + i]));
      float* const to = &(*sums)[i];
      hn::StoreU(hn::MulAdd(hn::ConvertTo(Floats(), bytes), scale, hn::LoadU(Floats(), to)),
                 Floats(), to);
    });
    is_at_work = true;
  }
  return is_at_work;
}

// Computes the coefficients of a map in a block. False: they are all 0.
// The clamp to 1 applies to the masks by skin weight alone, before painted masks are added, as in
// the fragment shader.
bool Coefficients(const ComposeJob& job, std::size_t map, std::size_t first, Numbers* sums) {
  sums->fill(0.0f);
  bool is_at_work = AddMasks(job, job.tile->skinned, map, first, sums);
  if (is_at_work) {
    ForLanes([&](std::size_t i) HWY_ATTR {
      float* const to = &(*sums)[i];
      hn::StoreU(hn::Min(hn::LoadU(Floats(), to), hn::Set(Floats(), 1.0f)), Floats(), to);
    });
  }
  is_at_work |= AddMasks(job, job.tile->masks, map, first, sums);
  return is_at_work;
}

// n.x / n.z, n.y / n.z, variance.
using Slopes = std::array<Numbers, 3>;
// Red, green, blue and cavity.
using Looks = std::array<Numbers, 4>;

// Loads `count` planes of half floats.
template <std::size_t count>
void LoadPlanes(const std::vector<std::uint16_t>& planes, std::size_t first,
                std::array<Numbers, count>* numbers) {
  ForLanes([&](std::size_t i) HWY_ATTR {
    for (std::size_t k = 0; k < 3; ++k) {
      hn::StoreU(LoadHalves(&planes[k * kPlane + first + i]), Floats(), &(*numbers)[k][i]);
    }
  });
}

// Variances add as squares, because the maps are treated as independent.
void AddSlopes(const ComposeJob& job, std::size_t map, std::size_t first,
               const Numbers& coefficients, Slopes* sums) {
  const std::vector<std::uint16_t>& from = job.tile->maps[map].slopes;
  const Float amplitude = hn::Set(Floats(), job.strengths->amplitudes[map]);
  ForLanes([&](std::size_t i) HWY_ATTR {
    const Floats d;
    const Float w = hn::Mul(hn::LoadU(d, &coefficients[i]), amplitude);
    for (std::size_t k = 0; k < 3; ++k) {
      float* const to = &(*sums)[k][i];
      const Float by = k < 2 ? w : hn::Mul(w, w);
      hn::StoreU(hn::MulAdd(by, LoadHalves(&from[k * kPlane + first + i]), hn::LoadU(d, to)), d,
                 to);
    }
  });
}

// Multiplies colour and cavity by 1 + w (look - 1), which is neutral at w = 0. Sums of masks times
// the strength may exceed 1, hence the clamp at 0.
void MultiplyLooks(const ComposeJob& job, std::size_t map, std::size_t first,
                   const Numbers& coefficients, Looks* looks) {
  const std::vector<std::uint16_t>& from = job.tile->maps[map].looks;
  if (from.empty()) return;
  ForLanes([&](std::size_t i) HWY_ATTR {
    const Floats d;
    const Float one = hn::Set(d, 1.0f);
    for (std::size_t k = 0; k < 4; ++k) {
      const Float strength = hn::Set(d, k < 3 ? job.strengths->looks.x : job.strengths->looks.y);
      const Float scale = hn::Set(d, k < 3 ? job.strengths->scales[map] : 1.0f);
      const Float w = hn::Mul(hn::LoadU(d, &coefficients[i]), strength);
      const Float look = hn::MulSub(LoadHalves(&from[k * kPlane + first + i]), scale, one);
      const Float factor = hn::Max(hn::MulAdd(w, look, one), hn::Zero(d));
      float* const to = &(*looks)[k][i];
      hn::StoreU(hn::Mul(hn::LoadU(d, to), factor), d, to);
    }
  });
}

// Keeps green at or above min(base, cavity_albedo). Otherwise cavity() of
// shaders/scene/surface_frag.glsl, which detects painted hollows by their dark base colour, would
// mistake a wrinkle for one.
void KeepAboveCavity(const ComposeTile& tile, std::size_t first, Looks* looks) {
  const Float cavity_albedo = hn::Set(Floats(), tile.cavity_albedo);
  ForLanes([&](std::size_t i) HWY_ATTR {
    float* const green = &(*looks)[1][i];
    const Float least = hn::Min(LoadHalves(&tile.colour[kPlane + first + i]), cavity_albedo);
    hn::StoreU(hn::Max(hn::LoadU(Floats(), green), least), Floats(), green);
  });
}

// Index of a texel in the output.
HWY_INLINE std::size_t Place(const ComposeJob& job, std::size_t texel) {
  return 4 * (texel / ComposeTile::kSide * job.stride + texel % ComposeTile::kSide);
}

// Stores first and second moments, x, y, E[x^2] and E[y^2], like WithMoments(). Filtering keeps
// moments exact, and the shader recovers the variance from them.
void StoreSlopes(const ComposeJob& job, std::size_t first, const Slopes& sums) {
  ForLanes([&](std::size_t i) HWY_ATTR {
    const Floats d;
    const Float x = hn::LoadU(d, &sums[0][i]);
    const Float y = hn::LoadU(d, &sums[1][i]);
    const Float variance = hn::LoadU(d, &sums[2][i]);
    hn::StoreInterleaved4(ToHalves(x), ToHalves(y), ToHalves(hn::MulAdd(x, x, variance)),
                          ToHalves(hn::MulAdd(y, y, variance)), Words(),
                          &job.slopes[Place(job, first + i)]);
  });
}

void StoreLooks(const ComposeJob& job, std::size_t first, const Looks& looks) {
  ForLanes([&](std::size_t i) HWY_ATTR {
    hn::StoreInterleaved4(ToHalves(&looks[0][i]), ToHalves(&looks[1][i]), ToHalves(&looks[2][i]),
                          ToHalves(&looks[3][i]), Words(), &job.colours[Place(job, first + i)]);
  });
}

// One block at a time goes through all maps, so that the sums stay in the cache.
void ComposeBlock(const ComposeJob& job, std::size_t first) {
  const ComposeTile& tile = *job.tile;
  const bool has_looks = !tile.colour.empty();
  Numbers coefficients;
  Slopes slopes;
  Looks looks;
  LoadPlanes(tile.slopes, first, &slopes);
  if (has_looks) {
    LoadPlanes(tile.colour, first, &looks);
    looks[3].fill(1.0f);
  }
  for (std::size_t map = 0; map < tile.maps.size(); ++map) {
    if (!Coefficients(job, map, first, &coefficients)) continue;
    AddSlopes(job, map, first, coefficients, &slopes);
    if (has_looks) MultiplyLooks(job, map, first, coefficients, &looks);
  }
  StoreSlopes(job, first, slopes);
  if (!has_looks) return;
  KeepAboveCavity(tile, first, &looks);
  StoreLooks(job, first, looks);
}

void ComposeAll(const ComposeJob& job) {
  for (std::size_t first = 0; first < kPlane; first += kBlock) ComposeBlock(job, first);
}

}  // namespace furrow::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace furrow::render {
namespace {

HWY_EXPORT(ComposeAll);

bool HasPlanes(const std::vector<std::uint16_t>& halves, std::size_t planes) {
  return halves.size() == planes * ComposeTile::kTexels;
}

// Checks all sizes before the SIMD code runs, which reads without bounds checks.
bool IsWhole(const ComposeTile& tile, std::size_t channels) {
  if (!HasPlanes(tile.slopes, 3) || !(tile.colour.empty() || HasPlanes(tile.colour, 3))) {
    return false;
  }
  for (const ComposeTile::Map& map : tile.maps) {
    if (!HasPlanes(map.slopes, 3) || !(map.looks.empty() || HasPlanes(map.looks, 4))) return false;
  }
  const auto is_whole = [&](const ComposeTile::Mask& mask) {
    return mask.channel < channels && mask.values.size() == ComposeTile::kTexels;
  };
  return std::ranges::all_of(tile.masks, is_whole) && std::ranges::all_of(tile.skinned, is_whole);
}

}  // namespace

bool ComposeJob::Validate() const {
  if (tile == nullptr || strengths == nullptr || tile->maps.empty()) return false;
  const std::size_t maps = tile->maps.size();
  if (stride < ComposeTile::kSide) return false;
  const std::size_t halves = 4 * (stride * (ComposeTile::kSide - 1) + ComposeTile::kSide);
  return strengths->amplitudes.size() == maps && strengths->scales.size() == maps &&
         strengths->weights.size() % maps == 0 &&
         IsWhole(*tile, strengths->weights.size() / maps) && slopes.size() >= halves &&
         colours.size() >= (tile->colour.empty() ? 0 : halves);
}

bool ComposeJob::Run() const {
  if (!Validate()) return false;
  HWY_DYNAMIC_DISPATCH(ComposeAll)(*this);
  return true;
}

}  // namespace furrow::render
#endif  // HWY_ONCE
