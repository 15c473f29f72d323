// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"

// The picture that hair cards share. Tiles of strands are side by side, with gaps between the
// strands. Strands run from the root (top) to the tip (bottom).
namespace furrow::authoring {

inline constexpr int kFullTiles = 6;    // dense, for the body of the hair
inline constexpr int kSparseTiles = 2;  // a few strands, for hairlines and stray hair
// v, pointing down, at which the strands end. The caller paints the rows below, for example the
// cap.
inline constexpr float kStrandBottom = 0.72f;
// Alpha below which a strand is not drawn; for Material::alpha_cutoff.
inline constexpr float kStrandCutoff = 0.40f;

// The look of the strands. Colours are sRGB, [0, 1].
struct StrandLook {
  glm::vec3 colour{0.25f, 0.175f, 0.125f};
  glm::vec3 grey{0.66f, 0.65f, 0.63f};  // colour of grey strands
  float grey_share = 0.0f;              // fraction of grey strands, [0, 1]
};

// The texture coordinates of a point of a card. `tile`: the first kFullTiles tiles are dense, the
// next kSparseTiles are sparse. `across`: -1 one edge of the card to 1 the other. `along`: 0 root
// to 1 tip.
[[nodiscard]] glm::vec2 StrandUv(int tile, float across, float along);

// Paints all tiles: colour and coverage into `colour` (4 channels), and the slopes across the
// strands into `normals` (3 channels, same size), so that each strand catches the light. Rows below
// kStrandBottom stay unchanged.
void PaintStrands(const StrandLook& look, character::Picture* colour, character::Picture* normals);

}  // namespace furrow::authoring
