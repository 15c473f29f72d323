// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/face_parameters.h"
#include "character/character.h"

namespace furrow::authoring {

// Pictures of eyes, lashes and hair, and the masks of the face. Colours are sRGB. Masks are
// computed from the 3D position of a texel, not from its UV, so UV seams are invisible. `size`:
// width and height, texels.

// Both eyes side by side (width 2 * size, height size): iris, pupil, limbus, veined white.
[[nodiscard]] character::Picture PaintEyes(int size);
// The alpha texture of the strip of geometry that is one lash. Only a small part is opaque, so
// small mip levels fall below the alpha cutoff of the material: a lash thinner than about a pixel
// disappears instead of becoming a row of dots.
[[nodiscard]] character::Picture PaintLash();

// The share of light that the shadows of the lids let through, sRGB: a column of texels, dark up to
// v = 0.25 and white from v = 0.75 on, where MakeLidShades() begins and ends. The margins keep the
// two ends apart in small mip levels.
[[nodiscard]] character::Picture PaintLidShade();
// The pictures of the hair. The upper part shows strands with transparent gaps, the lower part the
// opaque cap of the scalp.
struct HairPictures {
  character::Picture colour;
  character::Picture normals;  // tangent space: the slopes of the strands
};
[[nodiscard]] HairPictures PaintHair(const character::Mesh& hair, const FaceParameters& face,
                                     int size);

// The masks of the eight facial regions, one per channel (red, green, blue, alpha): A holds brow_l,
// brow_r, glabella and nose, B holds eye_l, eye_r, mouth_l and mouth_r. Masks are 0 outside a
// region, on ears and on hands, and rise to at most 255 inside, with soft borders.
[[nodiscard]] character::Picture PaintMasksA(const character::Mesh& skin, int size);
[[nodiscard]] character::Picture PaintMasksB(const character::Mesh& skin, int size);

}  // namespace furrow::authoring
