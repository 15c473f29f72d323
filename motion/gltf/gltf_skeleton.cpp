// SPDX-License-Identifier: Apache-2.0
#include "motion/gltf/gltf_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "base/text.h"
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

// Per node: true if the animation moves it.
std::vector<bool> MovingNodes(const gltf::NodeForest& forest, const gltf::Animation& animation) {
  std::vector<bool> moves(forest.nodes.size(), false);
  for (const gltf::NodeTrack& track : animation.tracks) {
    if (track.target == gltf::TrackTarget::kMorphWeights) continue;
    moves[static_cast<std::size_t>(track.node)] = true;
  }
  return moves;
}

// Per node: the most nodes in a row, from this one down, that all move.
std::vector<int> MovingChains(const gltf::NodeForest& forest, const std::vector<bool>& moves) {
  std::vector<int> chains(forest.nodes.size(), 0);
  for (auto node = forest.order.rbegin(); node != forest.order.rend(); ++node) {
    const auto i = static_cast<std::size_t>(*node);
    if (!moves[i]) continue;
    int longest = 0;
    for (const int child : forest.nodes[i].children) {
      longest = std::max(longest, chains[static_cast<std::size_t>(child)]);
    }
    chains[i] = 1 + longest;
  }
  return chains;
}

// Per node: true if it belongs to the body of a skin. Such a node is a listed joint or lies below
// one, or below a moving node where branches of the body meet: hips that move no vertex are in no
// list. A branch leads to listed joints or is a limb: the skin of a head lists no leg. `joints`:
// the listed nodes and their ancestors.
std::vector<bool> NodesOfBodies(const gltf::NodeForest& forest, const std::vector<bool>& listed,
                                const std::vector<bool>& moves, const gltf::NodeSet& joints) {
  constexpr int kLimb = 3;  // moving nodes in a row; cameras and props have fewer
  const std::vector<int> chains = MovingChains(forest, moves);
  std::vector<bool> of_body = listed;
  for (const int index : forest.order) {
    const auto i = static_cast<std::size_t>(index);
    const gltf::Node& node = forest.nodes[i];
    const bool is_below =
        node.parent != gltf::kNone && of_body[static_cast<std::size_t>(node.parent)];
    const auto num_branches = std::ranges::count_if(node.children, [&](int child) {
      return joints.Has(child) || chains[static_cast<std::size_t>(child)] >= kLimb;
    });
    const bool is_junction = joints.Has(index) && moves[i] && num_branches > 1;
    if (is_below || is_junction) of_body[i] = true;
  }
  return of_body;
}

int SizeOf(const gltf::NodeForest& forest, const gltf::NodeSet& nodes) {
  return static_cast<int>(std::count_if(forest.order.begin(), forest.order.end(),
                                        [&](int node) { return nodes.Has(node); }));
}

// Adds nodes that move but that no skin lists, because no vertex follows them: nodes of the body
// (eyes, attachments, twist and helper joints), and those that move rigid meshes, which the import
// of avatars takes for joints, too. Cameras and props elsewhere in the scene stay out.
void AddMovingNodesOfBodies(const gltf::NodeForest& forest, const gltf::Animation& animation,
                            const std::vector<bool>& listed, gltf::Document* document,
                            gltf::NodeSet* joints) {
  const std::vector<bool> moves = MovingNodes(forest, animation);
  const std::vector<bool> of_body = NodesOfBodies(forest, listed, moves, *joints);
  const std::vector<bool> is_rigid_part = gltf::FindRigidParts(forest, *joints);
  std::vector<int> more;
  for (const int node : forest.order) {
    const auto i = static_cast<std::size_t>(node);
    if (moves[i] && (of_body[i] || is_rigid_part[i]) && !joints->Has(node)) more.push_back(node);
  }
  if (more.empty()) return;
  gltf::NodeSet all = *joints;
  for (const int node : more) all.AddWithAncestors(node);
  // The joints of the skins alone may fit.
  if (SizeOf(forest, all) > wrinkle::kMaxJoints) {
    document->Warn("animations", "left out " + Counted(more.size(), "moving node") +
                                     " below the joints of skins, because a skeleton has at most " +
                                     std::to_string(wrinkle::kMaxJoints) + " joints");
    return;
  }
  for (const int node : more) joints->AddWithAncestors(node);
}

// By preference: VRM's humanoid bones, the joints of skins with what moves below them, and else the
// trees that move. Ancestors are included, because their transforms move the joints.
Status ChooseJoints(const gltf::NodeForest& forest, const gltf::VrmAnimation& vrm,
                    const gltf::Animation& animation, gltf::Document* document,
                    gltf::NodeSet* joints) {
  if (!vrm.human_bones.empty()) {
    for (const auto& [name, node] : vrm.human_bones) joints->AddWithAncestors(node);
    return {};
  }
  if (gltf::NumSkins(*document) == 0 || vrm.present) {
    AddMovingTrees(forest, vrm, animation, joints);
    return {};
  }
  std::vector<bool> listed(forest.nodes.size(), false);
  for (std::size_t skin = 0; skin < gltf::NumSkins(*document); ++skin) {
    const Result<std::vector<int>> nodes = gltf::ReadSkinJoints(*document, skin);
    FURROW_RETURN_IF_ERROR(nodes);
    for (const int node : *nodes) {
      joints->AddWithAncestors(node);
      listed[static_cast<std::size_t>(node)] = true;
    }
  }
  AddMovingNodesOfBodies(forest, animation, listed, document, joints);
  return {};
}

}  // namespace

Result<GltfSkeleton> BuildGltfSkeleton(gltf::Document* document, const gltf::NodeForest& forest,
                                       const gltf::VrmAnimation& vrm,
                                       const gltf::Animation& animation, float scale) {
  gltf::NodeSet chosen(forest);
  FURROW_RETURN_IF_ERROR(ChooseJoints(forest, vrm, animation, document, &chosen));
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
