// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/transform.h"

namespace furrow::gltf {

inline constexpr int kNone = -1;  // no node, mesh, skin, material or image

// The extra that Furrow writes for the end of a joint: [x, y, z] in the node's space.
inline constexpr char kTailExtra[] = "furrow_tail";
// The extra that Furrow writes for the role of a character's joint: a name, such as "leftHand".
inline constexpr char kRoleExtra[] = "furrow_role";

struct Node {
  std::string name;  // may be empty, and several nodes may share one
  int parent = kNone;
  std::vector<int> children;
  Transform local;
  std::optional<glm::vec3> tail;  // kTailExtra
  std::string role;               // kRoleExtra, at most kMaxNameBytes; empty: none
  int mesh = kNone;               // below Document::num_meshes()
  int skin = kNone;               // in range
};

// All nodes of a file: a forest.
struct NodeForest {
  std::vector<Node> nodes;  // by glTF index
  std::vector<int> order;   // all nodes, parents before children
};

// Reads the hierarchy and every node's transform.
//
// - A `matrix` is decomposed. Shear and flat axes are warnings; see Decompose().
// - A rotation within 1e-6 of unit length is kept bit for bit, so that what Furrow wrote reads back
//   equal. Other rotations are normalised.
//
// Errors: kCyclic (a node below itself or below two nodes), kLimit (kMaxNodes), kSchema (an index
// out of range, a transform of the wrong size, a rotation of length 0, a role that is not a name),
// kNonFinite.
[[nodiscard]] Result<NodeForest> ReadNodes(Document* document);

// Rest-pose matrices from each node's space to model space.
[[nodiscard]] std::vector<glm::mat4> ModelMatrices(const NodeForest& forest);

}  // namespace furrow::gltf
