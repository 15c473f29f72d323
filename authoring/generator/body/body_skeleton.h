// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A joint of the default character. All rest rotations are the identity, so the axes of every joint
// are parallel to the model's axes.
struct JointPlace {
  std::string name;
  std::string parent;     // empty for the root
  glm::vec3 place{0.0f};  // model space, metres
};

// The joints of the body in T-pose (arms along X, palms down), 1.75 m tall, feet on y = 0, facing
// +Z. Joints of the face are children of `head` and `jaw` and named after the muscle that they
// move. The suffix "_l" is the subject's left, +X; "_r" is the right.
[[nodiscard]] std::vector<JointPlace> JointPlaces();

// The skeleton with the joints of JointPlaces(), parents first.
[[nodiscard]] wrinkle::Skeleton MakeSkeleton();

}  // namespace furrow::authoring
