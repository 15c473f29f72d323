// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "authoring/bake/bake.h"

// The planes of a baked map as pictures that a rig's WrinkleMap names.
namespace furrow::character::bake {

// Tangent-space normals: RGB = n * 0.5 + 0.5, 16 bits, green up.
[[nodiscard]] Picture NormalPicture(const BakedMap& map, std::string name);

// n.xy / n.z in red and green, 16 bits: a texel t stands for (2 t - 1) * scale, clamped.
[[nodiscard]] Picture DerivativePicture(const BakedMap& map, float scale, std::string name);

// Millimetres over the rest surface, one channel of 16 bits: (2 t - 1) * height_mm, clamped.
[[nodiscard]] Picture HeightPicture(const BakedMap& map, float height_mm, std::string name);

// One of the map's planes as it is, in as many channels as it has numbers a texel.
[[nodiscard]] Picture FloatPicture(const BakedMap& map, const std::vector<float>& plane,
                                   std::string name);

// How open a place is to the sky, one channel of 8 bits.
[[nodiscard]] Picture CavityPicture(const BakedMap& map, std::string name);

// What blood makes of skin's colour (blood.h): RGB, sRGB of 8 bits; a full texel stands for `scale`
// times the colour at rest.
[[nodiscard]] Picture ColourPicture(const BakedMap& map, float scale, std::string name);

// The map at half its size, each texel the mean of four; masks and statistics are left out.
// Precondition: an even size.
[[nodiscard]] BakedMap Halved(const BakedMap& map);

// Those of normal, height, cavity and colour that `map` names, to be packed with a character.
// Normals are as large as they were baked. The others change slowly over skin: half as large, but
// not below kSmallestHalf texels a side.
// Errors: kInvalidArgument (folds higher than the map's height_mm).
[[nodiscard]] Result<std::vector<Picture>> PicturesOf(const BakedMap& baked,
                                                      const wrinkle::WrinkleMap& map);
inline constexpr int kSmallestHalf = 512;

}  // namespace furrow::character::bake
