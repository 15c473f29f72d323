// SPDX-License-Identifier: Apache-2.0
#include "motion/gltf/gltf_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "gltf/scene/joints.h"
#include "gltf/scene/skins.h"

namespace furrow::motion {
namespace {

using wrinkle::kNoJoint;

static_assert(gltf::kNone == kNoJoint);

// Without a skin: the trees that move. The nodes of VRM's expressions and look-at carry values, so
// they are joints only if joints hang below them.
void AddMovingTrees(const gltf::NodeForest& forest, const gltf::VrmAnimation& vrm,
                    const gltf::Animation& animation, gltf::NodeSet* joints) {
  const auto carries_value = [&vrm](int node) {
    return node == vrm.look_at ||
           std::any_of(vrm.expressions.begin(), vrm.expressions.end(),
                       [node](const auto& expression) { return expression.second == node; });
  };
  for (const gltf::NodeTrack& track : animation.tracks) {
    const bool moves = track.target != gltf::TrackTarget::kMorphWeights;
    if (moves && !carries_value(track.node)) joints->AddTree(track.node);
  }
  for (std::size_t node = 0; vrm.present && node < forest.nodes.size(); ++node) {
    const bool is_leaf = forest.nodes[node].children.empty();
    if (is_leaf && carries_value(static_cast<int>(node))) joints->Remove(static_cast<int>(node));
  }
}

// By preference: VRM's humanoid bones, the joints of skins, and else the trees that move. Ancestors
// are included, because their transforms move the joints.
Status ChooseJoints(const gltf::Document& document, const gltf::NodeForest& forest,
                    const gltf::VrmAnimation& vrm, const gltf::Animation& animation,
                    gltf::NodeSet* joints) {
  if (!vrm.human_bones.empty()) {
    for (const auto& [name, node] : vrm.human_bones) joints->AddWithAncestors(node);
    return {};
  }
  if (gltf::NumSkins(document) == 0 || vrm.present) {
    AddMovingTrees(forest, vrm, animation, joints);
    return {};
  }
  for (std::size_t skin = 0; skin < gltf::NumSkins(document); ++skin) {
    const Result<std::vector<int>> nodes = gltf::ReadSkinJoints(document, skin);
    FURROW_RETURN_IF_ERROR(nodes);
    for (const int node : *nodes) joints->AddWithAncestors(node);
  }
  return {};
}

}  // namespace

Result<GltfSkeleton> BuildGltfSkeleton(gltf::Document* document, const gltf::NodeForest& forest,
                                       const gltf::VrmAnimation& vrm,
                                       const gltf::Animation& animation, float scale) {
  gltf::NodeSet chosen(forest);
  FURROW_RETURN_IF_ERROR(ChooseJoints(*document, forest, vrm, animation, &chosen));
  gltf::JointList list = gltf::ListJoints(forest, chosen, vrm.human_bones, document);
  GltfSkeleton result;
  result.joint_of_node.assign(forest.nodes.size(), kNoJoint);
  if (list.joints.empty()) return result;

  std::vector<wrinkle::JointDesc> joints;
  for (gltf::Joint& joint : list.joints) {
    if (joint.tail) *joint.tail *= scale;
    joints.push_back({std::move(joint.name),
                      joint.parent,
                      {joint.rest.translation * scale, joint.rest.rotation, joint.rest.scale},
                      joint.tail});
  }
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
  if (!skeleton.ok()) return skeleton.status().At("nodes");
  result.skeleton = std::move(*skeleton);
  // Skeleton::Create() may reorder joints; source_index() leads back to the node.
  for (int joint = 0; joint < result.skeleton.num_joints(); ++joint) {
    const auto source =
        static_cast<std::size_t>(result.skeleton.source_index()[static_cast<std::size_t>(joint)]);
    result.joint_of_node[static_cast<std::size_t>(list.joints[source].node)] = joint;
  }
  return result;
}

}  // namespace furrow::motion
