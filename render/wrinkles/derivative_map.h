// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"

namespace furrow::render {

// Steepest slope that is kept: a normal map's texel below the horizon has no derivative.
inline constexpr float kMaxDerivative = 16.0f;

// Two floats a texel, rows from the top: n.xy / n.z of the tangent-space normal, y up in the
// picture.
struct DerivativeMap {
  int width = 0;
  int height = 0;
  std::vector<float> texels;
};

// From a tangent-space normal map as glTF has it: component = 2 value - 1, green up. Not normalised
// maps are taken as they are, since only the ratio counts; slopes are clamped to kMaxDerivative.
[[nodiscard]] DerivativeMap DerivativesFromNormalMap(const character::Picture& picture);

// From a derivative map: the first two channels, as wrinkle/rig/rig.h says: (2 value - 1) *
// `scale`, and as they are in a picture of floats; clamped to kMaxDerivative.
[[nodiscard]] DerivativeMap DerivativesFromDerivativeMap(const character::Picture& picture,
                                                         float scale = 1.0f);

// Four floats a texel: the derivative and its squares, whose mips tell how much it varies (LEAN
// mapping, Olano and Baker 2010).
[[nodiscard]] std::vector<float> WithMoments(const DerivativeMap& map);

// Bilinear, texel centres at halves, edges clamped: to give maps of one array one size.
[[nodiscard]] DerivativeMap Resample(const DerivativeMap& map, int width, int height);

// The value of one channel in [0, 1], whatever the depth; a float as it is. A missing channel is 0,
// a missing alpha 1.
[[nodiscard]] float Texel(const character::Picture& picture, int x, int y, int channel);

// Any picture as 8-bit RGBA: grey is spread, a missing alpha is opaque.
[[nodiscard]] std::vector<std::uint8_t> ToRgba8(const character::Picture& picture);

}  // namespace furrow::render
