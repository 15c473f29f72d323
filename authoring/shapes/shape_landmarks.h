// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "authoring/shapes/face_skin.h"

namespace furrow::authoring {

// A landmark of both halves of a face; model space, metres. Empty where the character has no shape
// that shows the place.
struct LandmarkPair {
  std::optional<glm::vec3> left;
  std::optional<glm::vec3> right;
};

// Places on a face, found from what ARKit's blend shapes move.
struct ShapeLandmarks {
  LandmarkPair brow_inner;             // where browDown moves farthest
  LandmarkPair brow_outer;             // browOuterUp
  LandmarkPair inner_rise;             // browInnerUp
  LandmarkPair upper_lid;              // eyeBlink
  LandmarkPair lower_lid;              // the centre of eyeSquint
  LandmarkPair mouth_corner;           // mouthSmile
  LandmarkPair nose_wing;              // the centre of noseSneer, which moves the cheek farthest
  LandmarkPair cheek;                  // cheekSquint
  std::optional<glm::vec3> chin;       // jawOpen
  std::optional<glm::vec3> upper_lip;  // mouthRollUpper near the middle
  std::optional<glm::vec3> lower_lip;  // mouthRollLower near the middle
};

// Finds the landmarks. Each side is searched on its own half, since shapes of both sides would
// otherwise pick a half by chance. Centres are weighted by the fourth power of the motion.
[[nodiscard]] ShapeLandmarks FindShapeLandmarks(const FaceSkin& skin);

}  // namespace furrow::authoring
