// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"

// The picture that hair cards share: side by side, tiles of strands that run from the root (above)
// to the tip (below), with holes between them.
namespace furrow::character::paint {

inline constexpr int kFullTiles = 6;           // dense: the mass of the hair
inline constexpr int kSparseTiles = 2;         // a few strands: hairlines, stray hair
inline constexpr float kStrandBottom = 0.72f;  // v below which the picture is the caller's
inline constexpr float kStrandCutoff = 0.40f;  // for Material::alpha_cutoff

// sRGB.
struct StrandLook {
  glm::vec3 colour{0.25f, 0.175f, 0.125f};
  glm::vec3 grey{0.66f, 0.65f, 0.63f};
  float grey_share = 0.0f;  // of the strands, [0, 1]
};

// Where a point of a card lies in the picture. `tile`: [0, kFullTiles) full, the kSparseTiles after
// them sparse; `across` in [-1, 1], `along` in [0, 1] from root to tip.
[[nodiscard]] glm::vec2 StrandUv(int tile, float across, float along);

// Paints all tiles: colour and coverage (4 channels), and slopes across the strands as a normal map
// (3 channels) of the same size, so that light breaks on each strand. Leaves rows below
// kStrandBottom alone.
void PaintStrands(const StrandLook& look, Picture* colour, Picture* normals);

}  // namespace furrow::character::paint
