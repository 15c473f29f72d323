// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"

namespace furrow::render {

// Largest absolute slope, of a surface 3.6 degrees from vertical; steeper slopes are clamped.
inline constexpr float kMaxDerivative = 16.0f;

// A map of two floats per texel, rows from the top: the derivatives n.xy / n.z of the tangent-space
// normal, with y up in the picture.
struct DerivativeMap {
  int width = 0;
  int height = 0;
  std::vector<float> texels;
};

// Converts a tangent-space normal map in glTF's convention: component = 2 value - 1, green is up.
// The normals need not have unit length, because only the ratio matters. Slopes are clamped to
// kMaxDerivative.
[[nodiscard]] DerivativeMap DerivativesFromNormalMap(const character::Picture& picture);

// Reads a derivative map from the first two channels, as wrinkle/rig/rig.h defines it: (2 value -
// 1) * `scale` for integer pictures, the value itself for float pictures. Slopes are clamped to
// kMaxDerivative.
[[nodiscard]] DerivativeMap DerivativesFromDerivativeMap(const character::Picture& picture,
                                                         float scale = 1.0f);

// Converts a map to four floats per texel: the derivatives x and y and their squares. The mip
// levels of the squares give the variance of the derivatives (LEAN mapping, Olano and Baker 2010).
[[nodiscard]] std::vector<float> WithMoments(const DerivativeMap& map);

// Resamples a map bilinearly to `width` x `height` texels, so that all maps of a texture array have
// the same size. Texel centres lie at halves; coordinates are clamped at the edges.
[[nodiscard]] DerivativeMap Resample(const DerivativeMap& map, int width, int height);

// One channel (from 0) of the texel in column `x` and row `y`, both within the picture: in [0, 1]
// for integer pictures, the stored value for float pictures. A missing colour channel is 0, a
// missing alpha is 1.
[[nodiscard]] float Texel(const character::Picture& picture, int x, int y, int channel);

// Converts any picture to 8-bit RGBA. Grey is copied to all colour channels; a missing alpha is
// opaque.
[[nodiscard]] std::vector<std::uint8_t> ToRgba8(const character::Picture& picture);

}  // namespace furrow::render
