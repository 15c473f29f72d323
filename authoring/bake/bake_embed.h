// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "authoring/bake/request/baked_maps.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// Adds a picture to the character under `picture.name`, or under the first free name of that stem
// ("face_masks_a_2"). Returns the name, by which the rig finds the picture.
std::string AddRigPicture(character::Picture picture, character::Character* character);

// Embeds baked maps in a character without their pictures: "squash_normal", "squash_height",
// "squash_cavity" and, on skin, "squash_colour". The rig's maps then name them.
// Errors: those of WrinkleMapPictures(); kNotFound (the rig lacks a map).
[[nodiscard]] Status EmbedMaps(const BakedMaps& maps, character::Character* character);

}  // namespace furrow::authoring
