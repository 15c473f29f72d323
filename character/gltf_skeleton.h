// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/skeleton.h"

namespace tinygltf {
class Model;
}

namespace furrow::character {

// The nodes of a glTF that move a character, as a skeleton.
struct GltfSkeleton {
  wrinkle::Skeleton skeleton;
  std::vector<glm::mat4> inverse_bind_matrices;  // one a joint of the skeleton
  std::vector<int> joint_of_node;     // nearest joint at or above each node; 0 where there is none
  std::vector<int> exact_joint;       // the node's own joint, or kNoJoint
  std::vector<glm::mat4> node_model;  // of each node, rest pose
  int nameless_joints = 0;            // named "node_<number>"
};

// The joints of all skins and the nodes above them (all nodes where there is no skin). A joint's
// tail is the node's extra "furrow_tail", [x, y, z] in its space, where it is stated.
//
// Errors: kCyclic (a node below itself or below two), kLimit, kSchema (indices, sizes), kNonFinite,
// kInvalidArgument (two joints of one name), kUnsupported (skins that disagree about a joint's
// inverse bind matrix; shear). `where` is the field.
[[nodiscard]] Result<GltfSkeleton> ReadGltfSkeleton(const tinygltf::Model& model);

}  // namespace furrow::character
