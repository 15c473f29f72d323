// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/shapes/face_skin.h"
#include "authoring/shapes/shape_landmarks.h"

namespace furrow::authoring {

// Where the parts of a face lie: metres, model space, rest pose. What no shape shows follows from
// the rest by the proportions of an adult face.
struct FaceMeasures {
  float middle = 0.0f;        // x of the plane of symmetry
  float eye_distance = 0.0f;  // between the upper lids, > 0
  float eye_depth = 0.0f;     // z of the upper lids

  // Heights (y), from top to bottom.
  float brow = 0.0f;
  float lid = 0.0f;     // upper lid
  float wing = 0.0f;    // wings of the nose
  float corner = 0.0f;  // corners of the mouth
  float chin = 0.0f;

  float wing_x = 0.0f;    // half the width of the nose
  float corner_x = 0.0f;  // half the width of the mouth
  float corner_z = 0.0f;  // depth of the corners of the mouth
};

[[nodiscard]] FaceMeasures MeasureFace(const FaceSkin& skin, const ShapeLandmarks& landmarks);

// How deep folds are on such a face, as a fraction of an adult's, [0.3, 1]. A face that is short
// below its eyes is a child's, or a drawn one (anime): its skin is smooth, and folds of full depth
// look like scars on it.
[[nodiscard]] float FoldDepthOf(const FaceMeasures& face);

}  // namespace furrow::authoring
