// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// The nodes of a glTF file that move a character, as a skeleton.
struct GltfSkeleton {
  wrinkle::Skeleton skeleton;
  std::vector<glm::mat4> inverse_bind_matrices;  // one per joint of the skeleton
  std::vector<std::vector<int>> skin_joints;     // per skin: its joints in `skeleton`
  std::vector<int> joint_of_node;     // per node: the nearest joint at or above it; 0 for none
  std::vector<glm::mat4> node_model;  // per node: to model space in the rest pose
  int num_nameless_joints = 0;        // called "node_<index>"
};

// The joints of all skins and the nodes above them; all nodes if there is no skin. A joint without
// an inverse bind matrix gets the inverse of its rest pose (the identity if that is singular).
//
// Errors: gltf::ReadSkinJoints()'s, gltf::ReadInverseBindMatrices()'s, kSchema (no nodes), kLimit
// (wrinkle::kMaxJoints), kUnsupported (two skins with different inverse bind matrices for one
// joint). `where` is a field.
[[nodiscard]] Result<GltfSkeleton> ReadGltfSkeleton(gltf::Document* document,
                                                    const gltf::NodeForest& forest);

}  // namespace furrow::character
