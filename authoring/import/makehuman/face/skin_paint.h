// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/makehuman/face/face_landmarks.h"
#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// How much hair grows at the point `p` of the head: 0 none to 1 full. `p`: model space, metres. The
// hairline is high above the brows and lower at the temples; ears are free of hair.
[[nodiscard]] float ScalpAmount(const glm::vec3& p, const FaceLandmarks& face);

// What the painted skin and hair of a person show.
struct SkinLook {
  bool scalp = true;  // a shaved scalp
  bool brows = true;
  // Shares in [0, 1]. Age makes skin pale and spotted, hair grey.
  float old = 0.0f;
  float asian = 0.0f;
  float african = 0.0f;
};

// The colour of hair, sRGB, that is `colour` on a young caucasian.
[[nodiscard]] glm::vec3 HairColour(const glm::vec3& colour, const SkinLook& look);

// Paints the colour of the skin, 8-bit sRGB, by the position of each texel relative to the
// landmarks (MakeHuman's pictures are not read). `texels`: those that the skin covers. `size`:
// width and height, texels. The colour has regional hues (cheeks, nose and ears redder, chin and
// forehead yellower), lips, brows, a shaved scalp, and blotches at two scales.
[[nodiscard]] character::Picture PaintMakeHumanSkin(const std::vector<SurfaceTexel>& texels,
                                                    const FaceLandmarks& face, const SkinLook& look,
                                                    int size);

// Paints only the brows onto `picture`, 8-bit sRGB.
void PaintMakeHumanBrows(const std::vector<SurfaceTexel>& texels, const FaceLandmarks& face,
                         const SkinLook& look, character::Picture* picture);

// Deepens `normals` (tangent-space, 8 bits, green up) by the folds of `folds`, a map of the same
// UVs: what expressions have left in an old face. `amount`: fraction of their slopes, [0, 1].
void AddRestFolds(const character::Picture& folds, float amount, character::Picture* normals);

// Paints pores and fine furrows as a tangent-space normal map, 8 bits, green up.
[[nodiscard]] character::Picture PaintMakeHumanSkinNormals(const std::vector<SurfaceTexel>& texels,
                                                           const FaceLandmarks& face, int size);

// The masks of the eight facial regions, four per picture (RGBA, 8 bits, linear), with soft
// borders. Where regions overlap, their sum is at most 1.
//   first:  brow_l, brow_r, glabella, nose      second: eye_l, eye_r, mouth_l, mouth_r
struct FaceMasks {
  character::Picture first;
  character::Picture second;
};
// Paints the masks. `texels`: those that the skin covers. `size`: width and height, texels.
[[nodiscard]] FaceMasks PaintFaceMasks(const std::vector<SurfaceTexel>& texels,
                                       const FaceLandmarks& face, int size);

}  // namespace furrow::authoring
