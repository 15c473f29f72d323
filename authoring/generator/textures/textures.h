// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/face_parameters.h"
#include "character/character.h"

namespace furrow::authoring {

// All pictures are painted in model space at the surface point of each texel, so UV seams are
// invisible. Colours are sRGB.

// Both eyes side by side (2 size x size): iris, pupil, limbus, veined white.
[[nodiscard]] character::Picture PaintEyes(int size);
// The alpha of a lash's strip. Only a small part is opaque, so that small mip levels fall below
// kStrandCutoff: a lash thinner than about a pixel disappears instead of becoming a row of dots.
// The dark edge of the lid (PaintSkinColour) remains.
[[nodiscard]] character::Picture PaintLash();
// Strands with gaps (kStrandCutoff) above, the cap below, and the slopes of the strands.
struct HairPictures {
  character::Picture colour;
  character::Picture normals;
};
[[nodiscard]] HairPictures PaintHair(const character::Mesh& hair, const FaceParameters& face,
                                     int size);

// The masks of the eight facial regions: brow_l, brow_r, glabella, nose in the first picture,
// eye_l, eye_r, mouth_l, mouth_r in the second. They are soft, and empty on ears and hands.
[[nodiscard]] character::Picture PaintMasksA(const character::Mesh& skin, int size);
[[nodiscard]] character::Picture PaintMasksB(const character::Mesh& skin, int size);

}  // namespace furrow::authoring
