// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/face_landmarks.h"
#include "character/character.h"

namespace furrow::authoring {

// Short hair: locks that grow from the scalp (ScalpAmount() of skin_paint.h), combed from the whorl
// of the crown, a few millimetres at the nape and four centimetres on top. The same every time;
// each lock follows the joints of the place that it grows from. UVs as PaintMakeHumanHair() has
// them.
[[nodiscard]] character::Mesh BuildMakeHumanHair(const character::Mesh& skin,
                                                 const FaceLandmarks& face, int material);

// A group of lashes around the eye at `eye`: u runs along the lid, v from the tips (0) to the lid.
// They take up `reach` of the group's strip, (0, 1].
[[nodiscard]] character::Mesh BuildLashes(const BaseMesh& base, std::string_view group,
                                          const glm::vec3& eye, float reach, int material);

// 8-bit sRGB: strands run from the tips (top) to the roots.
[[nodiscard]] character::Picture PaintMakeHumanHair(int size);

// For Material::alpha_cutoff: from afar, where lashes are finer than texels, their fringe stays.
inline constexpr float kLashCutoff = 0.4f;

// 8-bit sRGB and alpha: dark lashes that taper, of uneven length.
[[nodiscard]] character::Picture PaintLashes(int size);

}  // namespace furrow::authoring
