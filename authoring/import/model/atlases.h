// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "character/character.h"

// The atlases of wrinkle maps: all skin shares one, and all cloth another.
namespace furrow::authoring {

// Selects, for skin and for cloth, the materials that share one wrinkle atlas, and clears
// Material::wrinkles of the others: materials whose UVs overlap those of a material chosen before.
// `first`: the material that comes first (-1: none); then the one with the largest surface. Returns
// the names of the materials that lose their wrinkles.
std::vector<std::string> ChooseAtlases(int first, character::Character* character);

// A part of an atlas of wrinkle maps.
struct AtlasTile {
  std::vector<std::string> materials;  // names
  float share = 1.0f;                  // of the atlas's area, (0, 1]
};

// Gives the materials of cloth (`cloth`) or skin tiles of their atlas, if UVs of different
// materials overlap: the meshes' UVs move into the tile, and Material::texture_scale and
// texture_offset lead back to the material's own textures. Materials that do not overlap share a
// tile.
//
// - `first`: the material of the face, whose tile gets the left 60% of the atlas (-1: none). The
//   other tiles share the rest, or the whole atlas if there is no first one, evenly. The largest
//   surface comes first.
// - The tiles have a margin of 1% on each side. UVs outside the unit square move into the tile as
//   one box, of which a square of a UDIM grid fills the tile.
// Call it before masks are painted or maps are baked. Returns the tiles; empty if nothing overlaps,
// and then nothing changes.
std::vector<AtlasTile> TileAtlas(bool cloth, int first, character::Character* character);

// One sentence about the tiles of TileAtlas(), with the share of the texels that each has.
[[nodiscard]] std::string DescribeTiles(const std::vector<AtlasTile>& tiles, bool cloth);

}  // namespace furrow::authoring
