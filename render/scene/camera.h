// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "render/renderer.h"

namespace furrow::render {

// A camera as the shaders need it. Model space of the posed character; the camera looks down its
// -Z.
struct CameraFrame {
  glm::mat4 view_projection{1.0f};
  glm::vec3 position{0.0f};
  glm::mat4 view{1.0f};
  glm::vec3 target{0.0f};     // what it looks at
  float cot_half_fov = 1.0f;  // of the picture's height: scale from slope to [-1, 1]
  float near_plane = 0.0f;    // metres
  float far_plane = 0.0f;
  // The camera's heading: a rotation about +Y that takes "the camera looks to -Z" to where it
  // looks. The lights turn with it, so that every preset is lit alike.
  glm::mat3 heading{1.0f};

  [[nodiscard]] float focus_distance() const { return glm::distance(position, target); }
  // Pixels, in a picture of this height, of what is as tall as it is far away.
  [[nodiscard]] float PixelsPerSlope(int height) const {
    return 0.5f * static_cast<float>(height) * cot_half_fov;
  }
  // Metres around the target that a picture of this shape shows, to its corners and a bit more.
  [[nodiscard]] float StageRadius(float aspect) const {
    return 1.15f * focus_distance() / cot_half_fov * glm::length(glm::vec2(aspect, 1.0f));
  }
};

// How the studio moves with a subject: from the rest pose to where `model` has the followed joint,
// turned about +Y as its root turned. Nowhere where the camera follows none.
[[nodiscard]] glm::mat4 FollowTransform(const Camera& camera, const wrinkle::Skeleton& skeleton,
                                        std::span<const glm::mat4> model);

// `model`: the pose, num_joints long; the camera follows it as Camera::follow_joint says, to where
// the subject stands (`placement`). `aspect`: width / height. Near and far planes are set from the
// distance to the target.
[[nodiscard]] CameraFrame ComputeCamera(const Camera& camera, const wrinkle::Skeleton& skeleton,
                                        std::span<const glm::mat4> model, float aspect,
                                        const glm::mat4& placement = glm::mat4(1.0f));

// Renderer::Preset(), all of them: (name, camera).
[[nodiscard]] std::vector<std::pair<std::string, Camera>> CameraPresets(
    const character::Character& character);
// The error that lists the names.
[[nodiscard]] Status UnknownPreset(std::string_view name);

}  // namespace furrow::render
