// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/joints.h"
#include "gltf/scene/nodes.h"

namespace furrow::character {

// The nodes of a glTF file that become joints.
struct GltfJointChoice {
  std::vector<std::vector<int>> of_skins;  // per skin: the nodes of its joints
  gltf::JointList list;
};

// Chooses the joints of a character:
//
// - The joints of all skins and the nodes above them. Without a skin: all nodes, so that meshes can
//   follow any of them.
// - Rigid parts of the body (gltf::FindRigidParts()) that something moves by themselves, and the
//   nodes between: nodes that an animation of the file moves, the human bones of a VRM avatar, and
//   nodes with a role. Other rigid parts follow the nearest joint.
// - Rigid parts with a name of which `is_eye_name` returns true, unless a joint has this name. The
//   origin of such a node must lie within its meshes, because an eye turns about it. VRM avatars
//   name their eyes themselves. Empty: none.
//
// If the rigid parts would exceed wrinkle::kMaxJoints, they follow the nearest joint, with a
// warning. Joints of a VRM avatar get their roles from it, unless the file states roles.
//
// Errors: kSchema (no nodes), and those of gltf::ReadSkinJoints().
[[nodiscard]] Result<GltfJointChoice> ChooseGltfJoints(
    gltf::Document* document, const gltf::NodeForest& forest,
    const std::function<bool(const std::string&)>& is_eye_name);

}  // namespace furrow::character
