// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace furrow::render {

// A camera of a request. Positions are in metres, in the model space of the character's rest pose.
struct Camera {
  glm::vec3 position{0.0f, 1.6f, 0.8f};
  glm::vec3 target{0.0f, 1.6f, 0.0f};
  float fov_y_degrees = 24.0f;  // vertical field of view, [1, 150]
  // Applies the angle to the picture's width where the picture is taller than wide, so that a
  // portrait format shows the whole width of a head. Head presets set this.
  bool fit_shorter_side = false;
  // Index of the joint of the character that camera and lights follow: they move with the joint
  // from its rest position and turn about +Y with turn_joint. -1: the camera stays where it is.
  int follow_joint = -1;
  // The joint whose turn the camera takes while it follows: the body's first joint. -1: the root.
  int turn_joint = -1;
};

}  // namespace furrow::render
