// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/skin_grain.h"

#include <algorithm>
#include <cmath>

#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// The cells of the net with their own lines, and groups of cells, which change the height along a
// fold.
struct Octave {
  float size;  // metres; noise of size 1 has a wavelength of about 2
  float share;
  vec3 offset;
};
constexpr Octave kOctaves[] = {{0.00025f, 0.5f, {9.0f, 2.0f, 4.0f}},
                               {0.0006f, 0.6f, {3.0f, 0.0f, 7.0f}},
                               {0.0015f, 0.8f, {0.0f, 11.0f, 0.0f}},
                               {0.0040f, 0.6f, {5.0f, 0.0f, 0.0f}}};
constexpr float kStep = 0.05f;   // of an octave's size, for derivatives
constexpr float kSteep = 0.25f;  // height of the grain's own structure, as a share of its size

}  // namespace

FoldSample SkinGrain::Apply(const FoldSample& fold, const vec3& position, const vec3& tangent,
                            const vec3& bitangent, float smallest) const {
  constexpr float kFlat = 1e-7f;  // metres
  FoldSample grained = fold;
  const float h = fold.height;
  if (strength_ <= 0.0f || std::abs(h) < kFlat) return grained;
  for (const Octave& octave : kOctaves) {
    const float shown = Smoothstep(0.7f * smallest, 1.4f * smallest, 2.0f * octave.size);
    const float share = strength_ * octave.share * shown;
    if (share <= 0.0f) continue;
    const vec3 p = position / octave.size + octave.offset;
    const float noise = SignedNoise(p);
    const vec2 noise_slope =
        vec2(SignedNoise(p + kStep * tangent) - noise, SignedNoise(p + kStep * bitangent) - noise) /
        (kStep * octave.size);
    const float limit = kSteep * octave.size;
    const float bounded = h * limit / (limit + std::abs(h));
    // The derivative of `bounded` by h.
    const float gain = limit * limit / ((limit + std::abs(h)) * (limit + std::abs(h)));
    grained.height += share * noise * bounded;
    grained.slope += share * (noise_slope * bounded + noise * gain * fold.slope);
  }
  const float scale = grained.height / h;
  grained.cavity = std::clamp(1.0f - (1.0f - fold.cavity) * scale, 0.0f, 1.0f);
  return grained;
}

}  // namespace furrow::authoring
