// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "authoring/shapes/arkit_face.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// Marks the material of a face of blend shapes as skin that wrinkles, as ProposeShapeFace() does.
// Returns its index in Character::materials; -1 if there is no such face, or it has no material.
int MarkFace(const ArkitFace& face, character::Character* character);

// Proposes the wrinkle rig of a character with a face of blend shapes: the drivers, feeds and
// exports of `arkit` (the shipped rig arkit), with masks painted from what the shapes move, and the
// drivers, regions and maps of the character's present rig that its body's joints drive.
//
// - Masks: two pictures of `size` x `size` texels in the UVs of the face (PaintFaceMasks()).
// - Atlases (ChooseAtlases()): other materials whose UVs overlap get no wrinkles. TileAtlas()
//   before prevents this.
// - Regions of the body fold cloth by the maps of the present rig, if a material is cloth. Bent
//   hinges and twists also fold bare skin, by maps of their own, named "skin_" and the cloth's map.
// Returns remarks, one sentence each: shapes that are missing or move nothing, and materials
// without wrinkles. Wrinkle maps have no pictures afterwards; see BakeShapeFace().
// `face`: made from the character. Errors: those of FaceSkin::Create(), which leave the character
// unchanged.
[[nodiscard]] Result<std::vector<std::string>> ProposeShapeFace(const wrinkle::Rig& arkit,
                                                                const ArkitFace& face, int size,
                                                                character::Character* character);

// Bakes and embeds the wrinkle maps of the character's rig from the strain of its shapes, of their
// combinations and of its joints, and from `strokes`, which are drawn on the default character's
// face and move to this one (TransferStrokes()). `size`: texels per side. `depth`: factor for the
// folds of skin, [0, 4], beside that of FoldDepthOf(). `progress`: see Bake(). Returns warnings of CheckSurfaces() and notes of
// CollectBakePoses(). Errors: those of these, of FaceSkin::Create(), Bake() and EmbedMaps().
[[nodiscard]] Result<std::vector<std::string>> BakeShapeFace(
    const ArkitFace& face, std::span<const BakeStroke> strokes, int size, float depth,
    const std::function<bool(float)>& progress, character::Character* character);

}  // namespace furrow::authoring
