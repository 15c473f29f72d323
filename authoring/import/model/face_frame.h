// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/model/joint_finder.h"
#include "character/character.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The correspondence between the joints of two faces.
struct FaceMatch {
  std::vector<int> joint;     // per joint of the model: the target's joint, or kNoJoint
  std::vector<bool> by_tail;  // per joint of the model: the target's tail matches, not its origin

  // The target's joint for a joint of the model; kNoJoint if there is none, and for kNoJoint.
  [[nodiscard]] int Of(int model_joint) const;
};

// Matches the joints below the heads of two skeletons, the model and the target. Both must be
// upright
// (+Y) and face +Z.
//
// - `model_points`: for each joint of the model, the position to match, model space.
// - Positions are relative to the point between the eyes, in units of the distance between the
//   eyes. For the target's joints, origins and the tails of leaves are candidates.
// - Two joints match if each is the nearest to the other, within two fifths of the distance between
//   the eyes. Joints with equal names always match.
// - Eyes and jaw match by role. The result is empty if one skeleton has no eyes.
[[nodiscard]] FaceMatch MatchFaces(const wrinkle::Skeleton& model, const FoundJoints& model_joints,
                                   std::span<const glm::vec3> model_points,
                                   const wrinkle::Skeleton& target,
                                   const FoundJoints& target_joints);

// Indices of the joints below the head, without eyes, jaw and what a head wears: hair, hats,
// glasses, by their names (IsAdornment()) and those of the joints above them.
[[nodiscard]] bool IsAdornment(std::string_view joint_name);
[[nodiscard]] std::vector<int> FaceJoints(const wrinkle::Skeleton& skeleton,
                                          const FoundJoints& joints);

// The material of the head's skin: of the materials that may fold as skin, the one with the largest
// surface on the head and the joints below it. -1 if there is none.
[[nodiscard]] int HeadMaterial(const character::Character& character, const FoundJoints& joints);

}  // namespace furrow::authoring
