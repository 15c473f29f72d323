// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/model/joint_finder.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Which joint of one face lies where a joint of another does.
struct FaceMatch {
  std::vector<int> joint;     // by joint of the model: the target's, or kNoJoint
  std::vector<bool> by_tail;  // whether it is that joint's tail which lies there, not its origin

  // kNoJoint for kNoJoint, too.
  [[nodiscard]] int Of(int model_joint) const;
};

// Matches the joints below the heads of two skeletons, which both stand up, +Y, and face +Z.
//
// - `model_points`: where each joint of the model counts (model space): its control point.
// - Places are measured from the point between the eyes in distances between them. Of the target's
//   joints the origin and, of a leaf, the tail are tried.
// - A match is the nearest of both sides, within two fifths of the distance between the eyes. A
//   joint of the model whose very name the target has goes there.
// - Eyes and jaw go by their roles. Empty where one of the two has no eyes.
[[nodiscard]] FaceMatch MatchFaces(const wrinkle::Skeleton& model, const FoundJoints& model_joints,
                                   std::span<const glm::vec3> model_points,
                                   const wrinkle::Skeleton& target,
                                   const FoundJoints& target_joints);

// The joints below the head other than eyes and jaw.
[[nodiscard]] std::vector<int> FaceJoints(const wrinkle::Skeleton& skeleton,
                                          const FoundJoints& joints);

}  // namespace furrow::authoring
