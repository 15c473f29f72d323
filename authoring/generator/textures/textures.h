// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/face_parameters.h"
#include "character/character.h"

namespace furrow::character::generator {

// Everything here is painted in model space on the surface that a texel shows, so no seam of the
// unwrapping can be seen. Colours are sRGB.

// Iris, pupil, limbus and veined white, both eyes side by side (2 size x size).
[[nodiscard]] Picture PaintEyes(int size);
// How much of a lash's strip is hair, in alpha: so little that its mip levels end below
// paint::kStrandCutoff. Where a lash is thinner than about a pixel it is gone, not a row of dots;
// the dark edge of the lid (PaintSkinColour) stays.
[[nodiscard]] Picture PaintLash();
// Strands with holes between them (paint::kStrandCutoff), the cap below them, and the slopes of the
// strands.
struct HairPictures {
  Picture colour;
  Picture normals;
};
[[nodiscard]] HairPictures PaintHair(const Mesh& hair, const FaceParameters& face, int size);

// The eight facial regions in two RGBA textures: brow_l, brow_r, glabella, nose; eye_l, eye_r,
// mouth_l, mouth_r. Soft, and nothing on ears and hands.
[[nodiscard]] Picture PaintMasksA(const Mesh& skin, int size);
[[nodiscard]] Picture PaintMasksB(const Mesh& skin, int size);

}  // namespace furrow::character::generator
