// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "authoring/bake/request/baked_maps.h"
#include "character/character.h"

// Converts the planes of a baked map to the pictures that a rig's WrinkleMap names.
namespace furrow::authoring {

// Tangent-space normals: RGB = n * 0.5 + 0.5, 16 bits, green up.
[[nodiscard]] character::Picture NormalPicture(const BakedMap& map, std::string name);

// The slopes n.xy / n.z in red and green, 16 bits. A texel value t in [0, 1] stands for
// (2 t - 1) * scale; steeper slopes are clamped.
[[nodiscard]] character::Picture DerivativePicture(const BakedMap& map, float scale,
                                                   std::string name);

// Heights above the rest surface, one channel, 16 bits. A texel value t in [0, 1] stands for
// (2 t - 1) * height_mm millimetres; larger heights are clamped.
[[nodiscard]] character::Picture HeightPicture(const BakedMap& map, float height_mm,
                                               std::string name);

// A plane of the map as floats, with as many channels as the plane has values per texel.
[[nodiscard]] character::Picture FloatPicture(const BakedMap& map, const std::vector<float>& plane,
                                              std::string name);

// How open each point is to the sky, one channel, 8 bits: 0 closed, 255 open.
[[nodiscard]] character::Picture CavityPicture(const BakedMap& map, std::string name);

// The tint of the skin by the blood in it: RGB, sRGB, 8 bits. A texel of 255 stands for `scale`
// times the colour of the skin at rest.
[[nodiscard]] character::Picture ColourPicture(const BakedMap& map, float scale, std::string name);

// The map at half its size. Each texel is the mean of four; masks and statistics are left out.
// Precondition: width and height are even.
[[nodiscard]] BakedMap Halved(const BakedMap& map);

// The pictures that `map` names (normal, height, cavity, colour), to embed in a character. Normals
// keep the baked size. The other pictures vary slowly over skin, so they have half the size, unless
// that would be below kSmallestHalf texels per side.
// Errors: kInvalidArgument (folds higher than `map.height_mm`).
[[nodiscard]] Result<std::vector<character::Picture>> WrinkleMapPictures(
    const BakedMap& baked, const wrinkle::WrinkleMap& map);
inline constexpr int kSmallestHalf = 512;  // texels per side

}  // namespace furrow::authoring
