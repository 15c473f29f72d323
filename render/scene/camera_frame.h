// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "render/request/camera.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::render {

// A camera as the shaders need it, in the model space of the posed character. The camera looks
// along the -Z axis of its view space.
struct CameraFrame {
  glm::mat4 view_projection{1.0f};  // model space to clip space
  glm::vec3 position{0.0f};
  glm::mat4 view{1.0f};       // model space to view space
  glm::vec3 target{0.0f};     // the point that the camera looks at
  float cot_half_fov = 1.0f;  // cot(vertical field of view / 2): scales y / -z to [-1, 1]
  float near_plane = 0.0f;    // metres
  float far_plane = 0.0f;     // metres
  // Rotation about +Y from "the camera looks along -Z" to its actual heading. The lights turn with
  // it, so that every preset is lit alike.
  glm::mat3 heading{1.0f};

  [[nodiscard]] float focus_distance() const { return glm::distance(position, target); }
  // Pixels per unit of y / -z in view space: the height in pixels, in a picture `height` pixels
  // high, of an object that is as tall as its distance from the camera.
  [[nodiscard]] float PixelsPerSlope(int height) const {
    return 0.5f * static_cast<float>(height) * cot_half_fov;
  }
  // Radius in metres around the target that a picture of this shape shows, including its corners
  // and a margin of 15%. `aspect`: width / height.
  [[nodiscard]] float StageRadius(float aspect) const {
    return 1.15f * focus_distance() / cot_half_fov * glm::length(glm::vec2(aspect, 1.0f));
  }
};

// Returns the motion of camera and lights with a subject, in model space: the translation of the
// followed joint from its rest position to its position in `model`, and the rotation about +Y by
// the turn of the camera's turn_joint. The identity if the camera follows no joint. `model`: joint
// matrices in model space, one per joint of `skeleton`.
[[nodiscard]] glm::mat4 FollowTransform(const Camera& camera, const wrinkle::Skeleton& skeleton,
                                        std::span<const glm::mat4> model);

// Resolves `camera` for a pose. `model`: joint matrices of the followed subject, num_joints long;
// `placement`: its PosedSubject::placement; `aspect`: width / height. The near and far planes
// follow from the distance to the target.
[[nodiscard]] CameraFrame ComputeCamera(const Camera& camera, const wrinkle::Skeleton& skeleton,
                                        std::span<const glm::mat4> model, float aspect,
                                        const glm::mat4& placement = glm::mat4(1.0f));

}  // namespace furrow::render
