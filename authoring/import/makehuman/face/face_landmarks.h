// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The positions of facial features (model space, metres, rest pose), taken from MakeHuman's muscle
// joints. Colours, masks and folds are placed relative to them, so they fit every shape of the
// mesh.
struct FaceLandmarks {
  struct Side {
    glm::vec3 brow_inner;  // above the inner corner of the eye
    glm::vec3 brow_middle;
    glm::vec3 brow_outer;
    glm::vec3 temple;
    glm::vec3 eye;  // centre of the eyeball
    glm::vec3 pupil;
    glm::vec3 lower_lid;
    glm::vec3 fold_top;  // the nasolabial fold, beside the wing of the nose
    glm::vec3 fold_middle;
    glm::vec3 fold_bottom;  // beside the corner of the mouth
    glm::vec3 mouth_corner;
    glm::vec3 chin_side;
    glm::vec3 cheek;
  };
  Side sides[2];  // 0: the subject's left (+X), 1: right
  glm::vec3 nose_bridge;
  glm::vec3 nose_tip;
  glm::vec3 upper_lip;  // its fullest point
  glm::vec3 lower_lip;
  glm::vec3 lower_lip_bottom;
  glm::vec3 chin;
  glm::vec3 head;  // origin of the head joint
  glm::vec3 crown;
  float scale = 1.0f;  // size of the face; 1: pupils 62 mm apart

  // Metres on this face for `mm` millimetres on a face with `scale` 1.
  [[nodiscard]] float Millimetres(float mm) const { return mm * 0.001f * scale; }
};

// Finds the landmarks in a skeleton of MakeHuman's default rig. Errors: kNotFound (names the joint
// that the skeleton lacks), kInvalidArgument (both eyes at the same position).
[[nodiscard]] Result<FaceLandmarks> FindFaceLandmarks(const wrinkle::Skeleton& skeleton);

}  // namespace furrow::authoring
