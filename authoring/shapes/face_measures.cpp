// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/face_measures.h"

#include <algorithm>
#include <cmath>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

// The mean of both sides along one axis; `otherwise` if one side is missing.
float MeanOf(const LandmarkPair& pair, int axis, float otherwise) {
  if (!pair.left || !pair.right) return otherwise;
  return 0.5f * ((*pair.left)[axis] + (*pair.right)[axis]);
}

}  // namespace

FaceMeasures MeasureFace(const FaceSkin& skin, const ShapeLandmarks& at) {
  constexpr int kY = 1, kZ = 2;
  FaceMeasures face;
  const float unit = skin.eye_distance();
  face.middle = skin.middle();
  face.eye_distance = unit;
  face.eye_depth = MeanOf(at.upper_lid, kZ, 0.0f);
  face.lid = MeanOf(at.upper_lid, kY, 0.0f);
  face.brow = std::max(MeanOf(at.brow_inner, kY, face.lid + 0.35f * unit), face.lid + 0.15f * unit);
  face.corner =
      std::min(MeanOf(at.mouth_corner, kY, face.lid - 1.1f * unit), face.lid - 0.5f * unit);
  const float height = face.lid - face.corner;
  face.wing = std::clamp(MeanOf(at.nose_wing, kY, face.corner + 0.45f * height),
                         face.corner + 0.25f * height, face.lid - 0.25f * height);
  // The chin is below the mouth by about half the distance between mouth and eyes.
  const float chin = at.chin ? at.chin->y : face.corner - 0.55f * height;
  face.chin = std::clamp(chin, face.corner - 0.9f * height, face.corner - 0.35f * height);
  face.wing_x = 0.3f * unit;
  face.corner_x = 0.4f * unit;
  if (at.mouth_corner.left && at.mouth_corner.right) {
    const float width = at.mouth_corner.left->x - at.mouth_corner.right->x;
    face.corner_x = std::clamp(0.5f * width, 0.2f * unit, 0.8f * unit);
  }
  face.corner_z = MeanOf(at.mouth_corner, kZ, face.eye_depth);
  return face;
}

float FoldDepthOf(const FaceMeasures& face) {
  // From the upper lids to the chin, in distances between the eyes: 1.8 of adults, 1.6 of a small
  // child, 1.2 of a face drawn by VRoid Studio.
  constexpr float kDrawn = 1.25f;
  constexpr float kChild = 1.6f;
  constexpr float kLeast = 0.3f;
  const float height = (face.lid - face.chin) / std::max(face.eye_distance, 1e-6f);
  return std::lerp(kLeast, 1.0f, Smoothstep(kDrawn, kChild, height));
}

}  // namespace furrow::authoring
