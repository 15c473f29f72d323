// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "gltf/scene/nodes.h"

// Which nodes are joints, and what the joints are called. motion/ and character/ build their
// skeletons from these lists.
namespace furrow::gltf {

// A set of nodes.
class NodeSet {
 public:
  explicit NodeSet(const NodeForest& forest) : forest_(forest), in_(forest.nodes.size(), false) {}

  [[nodiscard]] bool Has(int node) const { return in_[static_cast<std::size_t>(node)]; }
  void AddWithAncestors(int node);
  // Adds the whole tree that holds `node`.
  void AddTree(int node);
  void AddAll() { in_.assign(in_.size(), true); }
  void Remove(int node) { in_[static_cast<std::size_t>(node)] = false; }

 private:
  const NodeForest& forest_;
  std::vector<bool> in_;
};

struct Joint {
  std::string name;    // unique in its list, not empty, at most kMaxNameBytes and a number
  int parent = kNone;  // index in the same list, before or after this joint; kNone for a root
  Transform rest;      // local
  std::optional<glm::vec3> tail;  // the joint's end in its own space
  int node = kNone;
  std::string role;  // Node::role
};

struct JointList {
  std::vector<Joint> joints;       // in the order of their nodes in the file
  std::vector<int> joint_of_node;  // per node: index into `joints`, or kNone
  int num_nameless = 0;            // nodes without a name
};

// Per node: true if it lies outside of `set` and below a node of it, and leads to a rigid mesh: one
// without a skin, on the node or below it. Eyeballs, teeth and props are such parts. A part follows
// the nearest joint above unless it is a joint itself.
[[nodiscard]] std::vector<bool> FindRigidParts(const NodeForest& forest, const NodeSet& set);

// The nodes of `set` as joints. A node whose parent is not in `set` becomes a root.
//
// - `names` overrides the names of some nodes: (name, node), each name unique. Other nodes with one
//   of these names, in any case, get a number without a warning.
// - A node without a name is called "node_<index>". A name that is taken gets "_2", "_3" and so
//   on, and a warning. A name longer than kMaxNameBytes is cut.
[[nodiscard]] JointList ListJoints(const NodeForest& forest, const NodeSet& set,
                                   std::span<const std::pair<std::string, int>> names,
                                   Document* document);

}  // namespace furrow::gltf
