// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/face/face_landmarks.h"
#include "authoring/import/makehuman/face/skin_paint.h"
#include "character/character.h"

namespace furrow::authoring {

// Builds short hair: locks that grow from the scalp, combed away from the whorl of the crown, a few
// millimetres long at the nape and four centimetres on top. Each lock follows the joints of the
// skin at its root. Equal inputs give equal meshes. `material`: index of the material. UVs fit
// PaintMakeHumanHair().
[[nodiscard]] character::Mesh BuildMakeHumanHair(const character::Mesh& skin,
                                                 const FaceLandmarks& face, int material);

// Builds the lashes of one lid from a group of the base mesh. `eye`: centre of the eyeball, metres.
// `reach`: length of the lashes as a fraction of the width of the group's strip, (0, 1]. u runs
// along the lid, v from the tips (0) to the lid (1).
[[nodiscard]] character::Mesh BuildLashes(const BaseMesh& base, std::string_view group,
                                          const glm::vec3& eye, float reach, int material);

// The colour of the hair, 8-bit sRGB. Strands run from the tips (top) to the roots (bottom).
// `size`: width and height, texels.
[[nodiscard]] character::Picture PaintMakeHumanHair(const SkinLook& look, int size);

// The colour and alpha of strands that run down the picture, 8-bit sRGB, for the strips of a
// foreign hairstyle. A few strands are missing, so that the strips do not look like paper. `size`:
// width and height, texels.
[[nodiscard]] character::Picture PaintHairStrands(const SkinLook& look, int size);

// Alpha below which a lash is not drawn, for Material::alpha_cutoff. 0.4 keeps a fringe where
// distant lashes are finer than texels.
inline constexpr float kLashCutoff = 0.4f;

// The colour and alpha of the lashes, 8-bit sRGB: dark, tapered, of uneven length. `size`: width
// and height, texels.
[[nodiscard]] character::Picture PaintLashes(int size);

}  // namespace furrow::authoring
