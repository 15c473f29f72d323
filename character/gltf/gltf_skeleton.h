// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "character/source_notes.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// The nodes of a glTF file that move a character, as a skeleton.
struct GltfSkeleton {
  wrinkle::Skeleton skeleton;
  wrinkle::JointRoles roles;  // Character::roles
  // Model space in the rest pose to joint space; one per joint of the skeleton.
  std::vector<glm::mat4> inverse_bind_matrices;
  std::vector<std::vector<int>> skin_joints;  // per skin: indices of its joints in `skeleton`
  // Per skin: empty, or one matrix per joint of the skin, from the space of its meshes to model
  // space. A vertex moves by the mean of its joints' matrices, by skin weight.
  std::vector<std::vector<glm::mat4>> skin_moves;
  // Per node of the file: index of the nearest joint at or above it; 0 if there is none.
  std::vector<int> joint_of_node;
  // Per node: its space to model space at rest. If the joint that the node's mesh follows is bound
  // in another pose: to model space in that pose, as its inverse bind matrix expects.
  std::vector<glm::mat4> node_model;
  int num_nameless_joints = 0;  // joints without a name, which get the name "node_<index>"
};

// Makes a skeleton from the joints that ChooseGltfJoints() finds with `options.is_eye_name`: those
// of skins, what moves rigid meshes, and the nodes above them. A joint without an inverse bind
// matrix gets the inverse of its model matrix in the rest pose, or the identity if that matrix is
// singular. `forest` describes the nodes of `document`; neither is kept.
//
// If two skins bind one joint differently, or the matrices of a skin contain a transform of the
// whole mesh, as quantised files have it, all joints get matrices from the rest pose and
// `skin_moves` tells how the meshes get there. That changes no picture if the matrices of a skin
// differ from those of the rest pose by one transform. Otherwise the rest pose is exact.
//
// Errors: those of gltf::ReadSkinJoints() and gltf::ReadInverseBindMatrices(), kSchema (no nodes,
// an unknown role), kLimit (more than wrinkle::kMaxJoints joints). `where` is a field.
[[nodiscard]] Result<GltfSkeleton> ReadGltfSkeleton(gltf::Document* document,
                                                    const gltf::NodeForest& forest,
                                                    const ReadOptions& options = {});

// The joints that ReadGltfSkeleton() would find without options, by name, with the roles that the
// file states for them; kNone: no role. Reads neither meshes nor buffers. Errors: kSchema (as
// there).
using NamedRoles = std::vector<std::pair<std::string, wrinkle::JointRole>>;
[[nodiscard]] Result<NamedRoles> ReadGltfRoles(gltf::Document* document,
                                               const gltf::NodeForest& forest);

}  // namespace furrow::character
