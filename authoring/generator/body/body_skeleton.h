// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A joint of the default character. Its position is in model space, metres. All rest rotations are
// the identity, so rotations in files are relative to the model's axes.
struct JointPlace {
  std::string name;
  std::string parent;  // empty for the root
  glm::vec3 place{0.0f};
};

// The joints of the body in T-pose (arms along X, palms down), 1.75 m tall, feet on y = 0, facing
// +Z. The muscles of the face are below `head` and `jaw`; each is named after the muscle that moves
// there. "_l" is the subject's left, +X.
[[nodiscard]] std::vector<JointPlace> JointPlaces();

[[nodiscard]] wrinkle::Skeleton MakeSkeleton();

}  // namespace furrow::authoring
