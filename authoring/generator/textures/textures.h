// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/face_parameters.h"
#include "character/character.h"

namespace furrow::authoring {

// Everything here is painted in model space on the surface that a texel shows, so no seam of the
// unwrapping can be seen. Colours are sRGB.

// Iris, pupil, limbus and veined white, both eyes side by side (2 size x size).
[[nodiscard]] character::Picture PaintEyes(int size);
// How much of a lash's strip is hair, in alpha: so little that its mip levels end below
// kStrandCutoff. Where a lash is thinner than about a pixel it is gone, not a row of dots;
// the dark edge of the lid (PaintSkinColour) stays.
[[nodiscard]] character::Picture PaintLash();
// Strands with holes between them (kStrandCutoff), the cap below them, and the slopes of the
// strands.
struct HairPictures {
  character::Picture colour;
  character::Picture normals;
};
[[nodiscard]] HairPictures PaintHair(const character::Mesh& hair, const FaceParameters& face,
                                     int size);

// The eight facial regions in two RGBA textures: brow_l, brow_r, glabella, nose; eye_l, eye_r,
// mouth_l, mouth_r. Soft, and nothing on ears and hands.
[[nodiscard]] character::Picture PaintMasksA(const character::Mesh& skin, int size);
[[nodiscard]] character::Picture PaintMasksB(const character::Mesh& skin, int size);

}  // namespace furrow::authoring
