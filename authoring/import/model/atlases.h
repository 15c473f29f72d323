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

// Gives every material of cloth a tile of its own in the atlas, if the UVs of two of them overlap:
// the meshes' UVs move into the tile, and Material::texture_scale and texture_offset lead back to
// the material's own textures. The tiles are squares of one size, with a margin of 1% on each side.
// Call it before masks are painted or maps are baked for cloth. Returns the names of the materials;
// empty if nothing overlaps, and then nothing changes.
std::vector<std::string> TileClothAtlas(character::Character* character);

}  // namespace furrow::authoring
