// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "rig/shapes/shape_match.h"
#include "wrinkle/shapes/joint_shapes.h"
#include "wrinkle/shapes/shape_rules.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::rig {

// A stream's skeleton and what the character does not take from it.
struct FaceJoints {
  const wrinkle::Skeleton& skeleton;
  const wrinkle::JointRoles& roles;        // one per joint; empty: unknown
  glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};  // from the stream's model space to Furrow's
  std::span<const std::string> unmatched;  // joints that the character lacks
};

// A character's face of shapes.
struct ShapeFace {
  const wrinkle::Skeleton& skeleton;
  const wrinkle::JointRoles& roles;  // one per joint; empty: unknown
  const wrinkle::MovedSurface& surface;
  std::span<const std::string> shapes;
  std::span<const wrinkle::ShapeRule> rules;
};

// Lets the joints of a stream's face that the character lacks move the character's shapes. The
// joints below the head and the ends of the last ones are placed on the character by the two eyes,
// whose distance gives the scale. The character's eyes are where eyeBlink moves most or, without
// such shapes, its joints. Empty if either face has no eyes, the stream no head, or fewer than 6
// joints lie on the surface.
[[nodiscard]] wrinkle::JointShapes MatchFaceJoints(const FaceJoints& joints, const ShapeFace& face,
                                                   const ShapeMatcher& matcher);

}  // namespace furrow::rig
