// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::character::generator {

// Everything here is painted in model space on the surface that a texel shows, so no seam of the
// unwrapping can be seen. Colours are sRGB.

// Skin, lips, brows, stubble, the shadow of the hair; the inside of the mouth.
[[nodiscard]] Picture PaintSkinColour(const Mesh& skin, int size);
// Pores, finer on nose and cheeks, and the fine creases of the lips: a tangent-space normal map.
[[nodiscard]] Picture PaintSkinNormals(const Mesh& skin, int size);
// Iris, pupil, limbus and veined white, both eyes side by side (2 size x size).
[[nodiscard]] Picture PaintEyes(int size);
// Strands of hair along the growth.
[[nodiscard]] Picture PaintHairColour(const Mesh& hair, int size);
// Shirt and trousers: weave, seams, belt.
[[nodiscard]] Picture PaintClothColour(const Mesh& clothes, int size);

// The eight facial regions in two RGBA textures: brow_l, brow_r, glabella, nose; eye_l, eye_r,
// mouth_l, mouth_r. Soft, and nothing on ears and hands.
[[nodiscard]] Picture PaintMasksA(const Mesh& skin, int size);
[[nodiscard]] Picture PaintMasksB(const Mesh& skin, int size);

}  // namespace furrow::character::generator
