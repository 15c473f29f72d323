// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/import/makehuman/face_landmarks.h"
#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// How much hair grows at a point of the head, [0, 1]: the hairline is high over the brows and falls
// to the temples; ears stand free.
[[nodiscard]] float ScalpAmount(const glm::vec3& p, const FaceLandmarks& face);

// MakeHuman's pictures are not read: the skin is painted here, by position, from the landmarks.

// 8-bit sRGB: skin with its regional hues (cheeks, nose and ears redder, chin and forehead
// yellower), lips, brows, a shaven scalp, and blotches at two scales.
[[nodiscard]] character::Picture PaintMakeHumanSkin(const std::vector<SurfaceTexel>& texels,
                                                    const FaceLandmarks& face, int size);

// Tangent-space normal map of pores and fine furrows, 8 bits, green up.
[[nodiscard]] character::Picture PaintMakeHumanSkinNormals(const std::vector<SurfaceTexel>& texels,
                                                           const FaceLandmarks& face, int size);

// The eight facial regions, four a picture (RGBA, 8 bits, linear), with soft borders; where regions
// overlap their sum stays at most 1.
//   first:  brow_l, brow_r, glabella, nose      second: eye_l, eye_r, mouth_l, mouth_r
struct FaceMasks {
  character::Picture first;
  character::Picture second;
};
[[nodiscard]] FaceMasks PaintFaceMasks(const std::vector<SurfaceTexel>& texels,
                                       const FaceLandmarks& face, int size);

}  // namespace furrow::authoring
