// SPDX-License-Identifier: Apache-2.0
#include "motion/gltf/gltf_skeleton.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <unordered_set>

#include <glm/gtc/quaternion.hpp>

#include "base/status.h"
#include "motion/clip/limits.h"

namespace furrow::motion {
namespace {

using wrinkle::JointDesc;
using wrinkle::Transform;

constexpr std::size_t kMaxNameBytes = 240;       // leaves room for a "_2"
constexpr const char* kTailKey = "furrow_tail";  // ClipToGlb() writes it

std::string NodeField(int node, const char* member = "") {
  return "nodes[" + std::to_string(node) + "]" + member;
}

// tinygltf asserts on a member of what is no object: outside data decides, so we look first.
const tinygltf::Value& Member(const tinygltf::Value& object, const char* key) {
  static const tinygltf::Value kNull;
  return object.IsObject() ? object.Get(key) : kNull;
}

// The node index in {"node": 3}, or an error.
Result<int> NodeOf(const GltfDocument& document, const tinygltf::Value& object,
                   const std::string& field) {
  const tinygltf::Value& node = Member(object, "node");
  if (!node.IsInt() || node.GetNumberAsInt() < 0 || node.GetNumberAsInt() >= document.num_nodes()) {
    return document.Error(StatusCode::kSchema, field + ".node", "is missing or out of range");
  }
  return node.GetNumberAsInt();
}

Status ReadNamedNodes(const GltfDocument& document, const tinygltf::Value& map,
                      const std::string& field, std::size_t most,
                      std::vector<std::pair<std::string, int>>* named) {
  const std::vector<std::string> names = map.Keys();
  if (names.size() > most) {
    return document.Error(StatusCode::kLimit, field, "more than " + std::to_string(most));
  }
  for (const std::string& name : names) {
    const Result<int> node = NodeOf(document, map.Get(name), field + "." + name);
    FURROW_RETURN_IF_ERROR(node);
    named->emplace_back(name, *node);
  }
  return {};
}

// Shear and mirroring are not kept: a joint's matrix is rigid but for scale.
Transform FromMatrix(const std::vector<double>& m) {
  Transform transform;
  glm::dmat3 axes(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
  transform.translation = glm::vec3(m[12], m[13], m[14]);
  const bool mirrored = glm::determinant(axes) < 0.0;
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(axes[i]) * (mirrored && i == 0 ? -1.0 : 1.0);
    transform.scale[i] = static_cast<float>(length);
    if (length != 0.0) axes[i] /= length;
  }
  const glm::dquat rotation = glm::quat_cast(axes);
  const double length = glm::length(rotation);
  if (length > 1e-6) transform.rotation = glm::quat(rotation / length);
  return transform;
}

// A node's own transform.
Result<Transform> NodeTransform(const GltfDocument& document, int index) {
  const tinygltf::Node& node = document.model().nodes[static_cast<std::size_t>(index)];
  if (!node.matrix.empty()) return FromMatrix(node.matrix);
  Transform transform;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!node.translation.empty())
      transform.translation[i] = static_cast<float>(node.translation[at]);
    if (!node.scale.empty()) transform.scale[i] = static_cast<float>(node.scale[at]);
  }
  if (!node.rotation.empty()) {
    const std::vector<double>& r = node.rotation;
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    const double length = glm::length(rotation);
    if (length < 1e-6) {
      return document.Error(StatusCode::kSchema, NodeField(index, ".rotation"), "has no length");
    }
    transform.rotation = glm::quat(rotation / length);
  }
  return transform;
}

std::optional<glm::vec3> ReadTail(const tinygltf::Node& node) {
  const tinygltf::Value& tail = Member(node.extras, kTailKey);
  if (!tail.IsArray() || tail.ArrayLen() != 3) return std::nullopt;
  glm::vec3 value(0.0f);
  for (int i = 0; i < 3; ++i) value[i] = static_cast<float>(tail.Get(i).GetNumberAsDouble());
  return std::isfinite(value.x + value.y + value.z) ? std::optional(value) : std::nullopt;
}

// Chooses nodes, then lists them in the document's order, which has parents first.
class JointChooser {
 public:
  explicit JointChooser(const GltfDocument& document)
      : document_(document), chosen_(static_cast<std::size_t>(document.num_nodes()), false) {}

  void AddWithAncestors(int node) {
    for (; node != -1 && !IsChosen(node); node = Parent(node)) Set(node, true);
  }

  // The whole tree that `node` stands in.
  void MarkTree(int node) {
    while (Parent(node) != -1) node = Parent(node);
    Set(node, true);
  }
  void SpreadToChildren() {
    for (const int node : document_.order()) {
      if (Parent(node) != -1 && IsChosen(Parent(node))) Set(node, true);
    }
  }

  void Remove(int node) { Set(node, false); }

  [[nodiscard]] std::vector<int> Nodes() const {
    std::vector<int> nodes;
    for (const int node : document_.order()) {
      if (IsChosen(node)) nodes.push_back(node);
    }
    return nodes;
  }

 private:
  [[nodiscard]] int Parent(int node) const {
    return document_.parents()[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] bool IsChosen(int node) const { return chosen_[static_cast<std::size_t>(node)]; }
  void Set(int node, bool chosen) { chosen_[static_cast<std::size_t>(node)] = chosen; }

  const GltfDocument& document_;
  std::vector<bool> chosen_;
};

std::vector<int> ChooseJoints(const GltfDocument& document, const VrmAnimation& vrm,
                              const std::vector<int>& moving) {
  JointChooser chooser(document);
  if (!vrm.human_bones.empty()) {
    for (const auto& [name, node] : vrm.human_bones) chooser.AddWithAncestors(node);
    return chooser.Nodes();
  }
  const std::vector<tinygltf::Skin>& skins = document.model().skins;
  if (!skins.empty() && !vrm.present) {
    for (const tinygltf::Skin& skin : skins) {
      for (const int joint : skin.joints) chooser.AddWithAncestors(joint);
    }
    return chooser.Nodes();
  }
  const auto is_expression = [&vrm](int node) {
    return node == vrm.look_at ||
           std::any_of(vrm.expressions.begin(), vrm.expressions.end(),
                       [node](const auto& expression) { return expression.second == node; });
  };
  for (const int node : moving) {
    if (!is_expression(node)) chooser.MarkTree(node);
  }
  chooser.SpreadToChildren();
  for (int node = 0; vrm.present && node < document.num_nodes(); ++node) {
    const bool leaf = document.model().nodes[static_cast<std::size_t>(node)].children.empty();
    if (leaf && is_expression(node)) chooser.Remove(node);
  }
  return chooser.Nodes();
}

std::string BaseName(const GltfDocument& document, const VrmAnimation& vrm, int node) {
  for (const auto& [name, bone] : vrm.human_bones) {
    if (bone == node) return name;
  }
  const std::string& name = document.model().nodes[static_cast<std::size_t>(node)].name;
  return name.empty() ? "node_" + std::to_string(node) : name.substr(0, kMaxNameBytes);
}

std::vector<std::string> UniqueNames(const GltfDocument& document, const VrmAnimation& vrm,
                                     const std::vector<int>& nodes) {
  std::unordered_set<std::string> taken;
  for (const auto& bone : vrm.human_bones) taken.insert(bone.first);
  const auto is_bone = [&vrm](int node) {
    return std::any_of(vrm.human_bones.begin(), vrm.human_bones.end(),
                       [node](const auto& bone) { return bone.second == node; });
  };
  std::vector<std::string> names;
  for (const int node : nodes) {
    const std::string base = BaseName(document, vrm, node);
    std::string name = base;
    for (int n = 2; !is_bone(node) && !taken.insert(name).second; ++n) {
      name = base + "_" + std::to_string(n);
    }
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

Result<VrmAnimation> ReadVrmAnimation(const GltfDocument& document) {
  VrmAnimation vrm;
  const auto& extensions = document.model().extensions;
  const auto found = extensions.find("VRMC_vrm_animation");
  if (found == extensions.end() || !found->second.IsObject()) return vrm;
  vrm.present = true;
  const std::string field = "extensions.VRMC_vrm_animation";
  Status status =
      ReadNamedNodes(document, Member(Member(found->second, "humanoid"), "humanBones"),
                     field + ".humanoid.humanBones", wrinkle::kMaxJoints, &vrm.human_bones);
  for (const char* kind : {"preset", "custom"}) {
    if (!status.ok()) return status;
    status = ReadNamedNodes(document, Member(Member(found->second, "expressions"), kind),
                            field + ".expressions." + kind, kMaxBlendShapes, &vrm.expressions);
  }
  if (!status.ok()) return status;
  if (Member(found->second, "lookAt").IsObject()) {
    const Result<int> node = NodeOf(document, Member(found->second, "lookAt"), field + ".lookAt");
    FURROW_RETURN_IF_ERROR(node);
    vrm.look_at = *node;
  }
  return vrm;
}

Result<GltfSkeleton> BuildGltfSkeleton(const GltfDocument& document, const VrmAnimation& vrm,
                                       const std::vector<int>& moving, float scale) {
  GltfSkeleton result;
  const std::vector<int> nodes = ChooseJoints(document, vrm, moving);
  if (nodes.empty()) return result;
  if (nodes.size() > static_cast<std::size_t>(wrinkle::kMaxJoints)) {
    return document.Error(StatusCode::kLimit, "nodes",
                          "more than " + std::to_string(wrinkle::kMaxJoints) + " joints");
  }
  const std::vector<std::string> names = UniqueNames(document, vrm, nodes);
  std::vector<int> joint_of_node(static_cast<std::size_t>(document.num_nodes()), wrinkle::kNoJoint);
  std::vector<JointDesc> joints;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const auto node = static_cast<std::size_t>(nodes[j]);
    const Result<Transform> rest = NodeTransform(document, nodes[j]);
    FURROW_RETURN_IF_ERROR(rest);
    JointDesc joint;
    joint.name = names[j];
    const int parent = document.parents()[node];
    if (parent != -1) joint.parent = joint_of_node[static_cast<std::size_t>(parent)];
    joint.rest = *rest;
    joint.rest.translation *= scale;
    joint.tail = ReadTail(document.model().nodes[node]);
    if (joint.tail) *joint.tail *= scale;
    joint_of_node[node] = static_cast<int>(j);
    joints.push_back(std::move(joint));
  }
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
  if (!skeleton.ok()) {
    return document.Error(skeleton.status().code(), "nodes", skeleton.status().what());
  }
  for (const std::int16_t source : skeleton->source_index()) {
    result.joint_nodes.push_back(nodes[static_cast<std::size_t>(source)]);
  }
  result.skeleton = std::move(*skeleton);
  return result;
}

}  // namespace furrow::motion
