// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

// A joint of the rest pose, in model space.
namespace furrow::wrinkle {

// The origin of `joint`, in the skeleton's units. `joint` must exist.
[[nodiscard]] inline glm::vec3 RestOrigin(const Skeleton& skeleton, int joint) {
  return glm::vec3(skeleton.rest_model()[joint][3]);
}

// The rotation of `joint`. kNoJoint, the parent of a root: the identity.
[[nodiscard]] inline glm::quat RestRotation(const Skeleton& skeleton, int joint) {
  return joint == kNoJoint ? glm::quat(1.0f, 0.0f, 0.0f, 0.0f)
                           : skeleton.rest_model_rotations()[joint];
}

}  // namespace furrow::wrinkle
