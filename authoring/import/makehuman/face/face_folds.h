// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "authoring/import/makehuman/face/face_landmarks.h"
#include "authoring/paint/surface_texels.h"

namespace furrow::authoring {

// Returns the folds of a face as strokes for Bake(), placed by the face's landmarks. They run
// across the pull of the muscle that causes them (FACS action units). Near a stroke, the bake draws
// it instead of folds from strain. `texels` cover the skin; the points of the strokes are moved
// onto their surface.
//
// - Map "stretch" (raised brows, lowered corners of the mouth): horizontal furrows of the forehead,
//   marionette lines, the crease under the lip, a pebbled chin.
// - Map "squash" (frowns, sneers, smiles, squinting): vertical lines of the glabella, the line
//   across the root of the nose, bunny lines, crow's feet, lines under the eye, nasolabial folds,
//   dimples.
[[nodiscard]] std::vector<BakeStroke> FaceStrokes(const FaceLandmarks& face,
                                                  const std::vector<SurfaceTexel>& texels);

}  // namespace furrow::authoring
