// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "authoring/import/makehuman/face_landmarks.h"
#include "authoring/paint/surface_texels.h"

namespace furrow::authoring {

// The folds of a face, placed by its landmarks: they run across the pull of the muscle that makes
// them (FACS' action units), and a bake lets them win over strain. Points lie on the surface that
// `texels` (of the skin) cover.
//
// - Map "stretch", what raised brows and lowered corners of the mouth make: horizontal furrows of
//   the forehead, marionette lines, the crease under the lip and a pebbled chin.
// - Map "squash", what frowns, sneers, smiles and screwed-up eyes make: verticals of the glabella,
//   the line across the nasal root, bunny lines, crow's feet, lines under the eye, nasolabial
//   folds, dimples.
[[nodiscard]] std::vector<BakeStroke> FaceStrokes(const FaceLandmarks& face,
                                                  const std::vector<SurfaceTexel>& texels);

}  // namespace furrow::authoring
