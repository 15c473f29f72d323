// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/face_landmarks.h"
#include "character/character.h"

namespace furrow::authoring {

// Short hair: locks that grow from the scalp (ScalpAmount()), combed away from the whorl of the
// crown, a few millimetres long at the nape and four centimetres on top. The result is always the
// same. Each lock follows the joints of its root. UVs fit PaintMakeHumanHair().
[[nodiscard]] character::Mesh BuildMakeHumanHair(const character::Mesh& skin,
                                                 const FaceLandmarks& face, int material);

// A group of lashes around the eye at `eye`. u runs along the lid, v from the tips (0) to the lid.
// The lashes use the fraction `reach` of the group's strip, (0, 1].
[[nodiscard]] character::Mesh BuildLashes(const BaseMesh& base, std::string_view group,
                                          const glm::vec3& eye, float reach, int material);

// The colour of the hair, 8-bit sRGB. Strands run from the tips (top) to the roots.
[[nodiscard]] character::Picture PaintMakeHumanHair(int size);

// For Material::alpha_cutoff: keeps a fringe where distant lashes are finer than texels.
inline constexpr float kLashCutoff = 0.4f;

// The colour and alpha of the lashes, 8-bit sRGB: dark, tapered, of uneven length.
[[nodiscard]] character::Picture PaintLashes(int size);

}  // namespace furrow::authoring
