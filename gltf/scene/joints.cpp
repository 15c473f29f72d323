// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/joints.h"

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <unordered_set>

#include "base/ascii.h"
#include "base/text.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

// Unique names for joints, which skeletons require and glTF does not. Names that VRM gives come
// first, and no other joint may take them, in any case: "Hips" would pass for the hips.
class JointNames {
 public:
  JointNames(std::span<const std::pair<std::string, int>> names, Document* document)
      : document_(*document) {
    for (const auto& [name, node] : names) {
      given_.emplace(node, name);
      taken_.insert(name);
      given_names_.insert(AsciiLower(name));
    }
  }

  std::string NameOf(const Node& node, int index) {
    const auto given = given_.find(index);
    if (given != given_.end()) return given->second;
    const std::string base =
        node.name.empty() ? "node_" + std::to_string(index) : CutText(node.name, kMaxNameBytes);
    // Starts at the number that the last joint of this name got: many equal names stay linear.
    int& number = next_number_.try_emplace(base, 2).first->second;
    const bool is_given = given_names_.contains(AsciiLower(base));
    std::string name = is_given ? base + "_" + std::to_string(number++) : base;
    while (!taken_.insert(name).second) name = base + "_" + std::to_string(number++);
    // VRM says which joint is meant.
    if (is_given) return name;
    if (name != base) {
      document_.Warn(
          "nodes[" + std::to_string(index) + "].name",
          "several joints are called " + Quoted(base) + "; this one becomes " + Quoted(name));
    } else if (base.size() < node.name.size()) {
      document_.Warn(
          "nodes[" + std::to_string(index) + "].name",
          "the name is longer than " + std::to_string(kMaxNameBytes) + " bytes and is cut");
    }
    return name;
  }

 private:
  Document& document_;
  std::unordered_map<int, std::string> given_;
  std::unordered_set<std::string> given_names_;  // in lowercase
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, int> next_number_;
};

}  // namespace

// Ancestors of a node in the set are in it already, so the walk ends there.
void NodeSet::AddWithAncestors(int node) {
  while (node != kNone && !Has(node)) {
    in_[static_cast<std::size_t>(node)] = true;
    node = forest_.nodes[static_cast<std::size_t>(node)].parent;
  }
}

// The whole tree of a node, from its root. If the node is in the set, so is its tree, which keeps
// many tracks of one tree linear.
void NodeSet::AddTree(int node) {
  const auto parent = [this](int of) { return forest_.nodes[static_cast<std::size_t>(of)].parent; };
  while (parent(node) != kNone) node = parent(node);
  if (Has(node)) return;
  std::vector<int> open = {node};
  while (!open.empty()) {
    const auto next = static_cast<std::size_t>(open.back());
    open.pop_back();
    in_[next] = true;
    const std::vector<int>& children = forest_.nodes[next].children;
    open.insert(open.end(), children.begin(), children.end());
  }
}

std::vector<bool> FindRigidParts(const NodeForest& forest, const NodeSet& set) {
  std::vector<bool> is_part(forest.nodes.size(), false);
  for (auto node = forest.order.rbegin(); node != forest.order.rend(); ++node) {
    const Node& from = forest.nodes[static_cast<std::size_t>(*node)];
    const bool has_rigid_mesh = from.mesh != kNone && from.skin == kNone;
    const bool leads_to_one = std::ranges::any_of(
        from.children, [&](int child) { return is_part[static_cast<std::size_t>(child)]; });
    is_part[static_cast<std::size_t>(*node)] = has_rigid_mesh || leads_to_one;
  }
  // A parent comes before its children, so its answer is final.
  for (const int node : forest.order) {
    const int parent = forest.nodes[static_cast<std::size_t>(node)].parent;
    const bool is_below =
        parent != kNone && (set.Has(parent) || is_part[static_cast<std::size_t>(parent)]);
    if (set.Has(node) || !is_below) is_part[static_cast<std::size_t>(node)] = false;
  }
  return is_part;
}

JointList ListJoints(const NodeForest& forest, const NodeSet& set,
                     std::span<const std::pair<std::string, int>> names, Document* document) {
  JointList list;
  JointNames namer(names, document);
  list.joint_of_node.assign(forest.nodes.size(), kNone);
  for (int index = 0; index < static_cast<int>(forest.nodes.size()); ++index) {
    if (!set.Has(index)) continue;
    const Node& node = forest.nodes[static_cast<std::size_t>(index)];
    list.joint_of_node[static_cast<std::size_t>(index)] = static_cast<int>(list.joints.size());
    list.num_nameless += node.name.empty() ? 1 : 0;
    list.joints.push_back(
        {namer.NameOf(node, index), kNone, node.local, node.tail, index, node.role});
  }
  // A second pass, because a parent may have a larger index than its child.
  for (Joint& joint : list.joints) {
    const int parent = forest.nodes[static_cast<std::size_t>(joint.node)].parent;
    if (parent != kNone) joint.parent = list.joint_of_node[static_cast<std::size_t>(parent)];
  }
  return list;
}

}  // namespace furrow::gltf
