// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A joint of the default character: its place in model space, metres. All rest rotations are
// identity, so a joint's turn in a file is the turn that one sees.
struct JointPlace {
  std::string name;
  std::string parent;  // empty for the root
  glm::vec3 place{0.0f};
};

// The body in T-pose (arms along X, palms down), 1.75 m, feet on y = 0, facing +Z; muscles of the
// face under `head` and `jaw`, named after what moves there. "_l" is the subject's left, +X.
[[nodiscard]] std::vector<JointPlace> JointPlaces();

[[nodiscard]] wrinkle::Skeleton MakeSkeleton();

}  // namespace furrow::authoring
