// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/nodes.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

std::string NodeField(std::size_t node, const char* member = "") {
  return "nodes[" + std::to_string(node) + "]" + member;
}

// Counts nodes with the same deviation, so that one warning covers all of them.
class NodeCount {
 public:
  void Add(std::size_t node) {
    if (count_++ == 0) first_ = node;
  }
  void WarnIfAny(Document* document, const std::string& what) const {
    if (count_ == 0) return;
    const std::string others =
        count_ == 1 ? "" : " (and " + Counted(count_ - 1, "other node") + ")";
    document->Warn(NodeField(first_, ".matrix"), what + others);
  }

 private:
  std::size_t count_ = 0;
  std::size_t first_ = 0;
};

// Copies `size` numbers and leaves `to` unchanged if there are none. JSON numbers are doubles,
// which may exceed a float.
Status ReadNumbers(const std::vector<double>& from, int size, const std::string& where, float* to) {
  if (from.empty()) return {};
  if (from.size() != static_cast<std::size_t>(size)) {
    return {StatusCode::kSchema, "expected " + std::to_string(size) + " numbers", where};
  }
  for (int i = 0; i < size; ++i) {
    to[i] = static_cast<float>(from[static_cast<std::size_t>(i)]);
    if (!std::isfinite(to[i])) {
      return {StatusCode::kNonFinite, "a number is outside the range of a float", where};
    }
  }
  return {};
}

// Furrow's own extra. Another tool's extra of the same name is ignored, not an error.
std::optional<glm::vec3> ReadTail(const tinygltf::Node& node) {
  if (!node.extras.IsObject()) return std::nullopt;
  const tinygltf::Value& tail = node.extras.Get(kTailExtra);
  if (!tail.IsArray() || tail.ArrayLen() != 3) return std::nullopt;
  glm::vec3 value(0.0f);
  for (int i = 0; i < 3; ++i) {
    const tinygltf::Value& number = tail.Get(i);
    if (!number.IsNumber()) return std::nullopt;
    value[i] = static_cast<float>(number.GetNumberAsDouble());
    if (!std::isfinite(value[i])) return std::nullopt;
  }
  return value;
}

// An invalid role is an error: without its roles, a package would move wrong and say nothing.
Status ReadRole(const tinygltf::Node& from, std::size_t index, std::string* role) {
  const tinygltf::Value& value = Member(from.extras, kRoleExtra);
  if (value.Type() == tinygltf::NULL_TYPE) return {};
  if (!value.IsString() || value.Get<std::string>().empty() ||
      value.Get<std::string>().size() > kMaxNameBytes) {
    return {StatusCode::kSchema, "expected the name of a role",
            NodeField(index, ".extras.") + kRoleExtra};
  }
  *role = value.Get<std::string>();
  return {};
}

// Builds a forest with every parent before its children in `order`.
class NodeReader {
 public:
  explicit NodeReader(Document* document) : document_(*document) {}

  Result<NodeForest> Run() {
    const std::vector<tinygltf::Node>& nodes = document_.model().nodes;
    if (nodes.size() > kMaxNodes) {
      return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxNodes) + " nodes",
                    "nodes");
    }
    forest_.nodes.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      FURROW_RETURN_IF_ERROR(ReadNode(nodes[i], i));
    }
    FURROW_RETURN_IF_ERROR(LinkParents());
    FURROW_RETURN_IF_ERROR(SortParentsFirst());
    sheared_.WarnIfAny(&document_, "the matrix has shear, which is dropped");
    flat_.WarnIfAny(&document_, "the matrix is flat (an axis has no length)");
    return std::move(forest_);
  }

 private:
  Status ReadNode(const tinygltf::Node& from, std::size_t index) {
    Node& node = forest_.nodes[index];
    node.name = from.name;
    node.children = from.children;
    node.tail = ReadTail(from);
    FURROW_RETURN_IF_ERROR(ReadRole(from, index, &node.role));
    if (from.mesh < kNone || from.mesh >= static_cast<int>(document_.num_meshes())) {
      return {StatusCode::kSchema, "mesh " + std::to_string(from.mesh) + " does not exist",
              NodeField(index, ".mesh")};
    }
    if (from.skin < kNone || from.skin >= static_cast<int>(document_.model().skins.size())) {
      return {StatusCode::kSchema, "skin " + std::to_string(from.skin) + " does not exist",
              NodeField(index, ".skin")};
    }
    node.mesh = from.mesh;
    node.skin = from.skin;
    return from.matrix.empty() ? ReadTransform(from, index, &node.local)
                               : ReadMatrix(from, index, &node.local);
  }

  Status ReadMatrix(const tinygltf::Node& from, std::size_t index, Transform* to) {
    // Decomposed in double, so that a matrix with small scales keeps the digits of its rotation.
    glm::mat4 checked;  // in the range of floats
    FURROW_RETURN_IF_ERROR(
        ReadNumbers(from.matrix, 16, NodeField(index, ".matrix"), glm::value_ptr(checked)));
    const Decomposition parts = Decompose(glm::make_mat4(from.matrix.data()));
    if (parts.has_shear) sheared_.Add(index);
    if (parts.is_flat) flat_.Add(index);
    *to = parts.transform;
    for (int i = 0; i < 3; ++i) {
      if (std::isfinite(to->scale[i])) continue;
      return {StatusCode::kNonFinite, "the scale is outside the range of a float",
              NodeField(index, ".matrix")};
    }
    return {};
  }

  static Status ReadTransform(const tinygltf::Node& from, std::size_t index, Transform* to) {
    float xyzw[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    FURROW_RETURN_IF_ERROR(ReadNumbers(from.translation, 3, NodeField(index, ".translation"),
                                       glm::value_ptr(to->translation)));
    FURROW_RETURN_IF_ERROR(ReadNumbers(from.rotation, 4, NodeField(index, ".rotation"), xyzw));
    FURROW_RETURN_IF_ERROR(
        ReadNumbers(from.scale, 3, NodeField(index, ".scale"), glm::value_ptr(to->scale)));
    to->rotation = glm::quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    // In double: the square of a tiny or huge quaternion leaves a float's range. Unit quaternions
    // keep their bits.
    const double length = glm::length(glm::dquat(to->rotation));
    if (length < 1e-6) {
      return {StatusCode::kSchema, "the rotation has length 0", NodeField(index, ".rotation")};
    }
    if (std::abs(length - 1.0) > 1e-6) {
      to->rotation = glm::quat(glm::dquat(to->rotation) / length);
    }
    return {};
  }

  Status LinkParents() {
    const int count = static_cast<int>(forest_.nodes.size());
    for (int i = 0; i < count; ++i) {
      const std::string field = NodeField(static_cast<std::size_t>(i), ".children");
      for (const int child : forest_.nodes[static_cast<std::size_t>(i)].children) {
        if (child < 0 || child >= count) {
          return {StatusCode::kSchema, "node " + std::to_string(child) + " does not exist", field};
        }
        int& parent = forest_.nodes[static_cast<std::size_t>(child)].parent;
        if (parent != kNone) {
          return {StatusCode::kCyclic, "node " + std::to_string(child) + " has two parents", field};
        }
        parent = i;
      }
    }
    return {};
  }

  // Breadth first, with the list itself as the queue.
  Status SortParentsFirst() {
    std::vector<Node>& nodes = forest_.nodes;
    std::vector<bool> reached(nodes.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].parent == kNone) forest_.order.push_back(static_cast<int>(i));
    }
    for (std::size_t i = 0; i < forest_.order.size(); ++i) {
      const auto node = static_cast<std::size_t>(forest_.order[i]);
      reached[node] = true;
      forest_.order.insert(forest_.order.end(), nodes[node].children.begin(),
                           nodes[node].children.end());
    }
    // Every node has at most one parent, so a node that no root reaches is part of a ring.
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!reached[i]) {
        return {StatusCode::kCyclic, "the node is below itself", NodeField(i, ".children")};
      }
    }
    return {};
  }

  Document& document_;
  NodeForest forest_;
  NodeCount sheared_;
  NodeCount flat_;
};

}  // namespace

Result<NodeForest> ReadNodes(Document* document) { return NodeReader(document).Run(); }

std::vector<glm::mat4> ModelMatrices(const NodeForest& forest) {
  std::vector<glm::mat4> model(forest.nodes.size());
  for (const int index : forest.order) {
    const Node& node = forest.nodes[static_cast<std::size_t>(index)];
    const glm::mat4 local = ToMatrix(node.local);
    model[static_cast<std::size_t>(index)] =
        node.parent == kNone ? local : model[static_cast<std::size_t>(node.parent)] * local;
  }
  return model;
}

}  // namespace furrow::gltf
