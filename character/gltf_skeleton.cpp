// SPDX-License-Identifier: Apache-2.0
#include "character/gltf_skeleton.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <tiny_gltf.h>

#include "base/status.h"
#include "character/gltf_accessor.h"

namespace furrow::character {
namespace {

using wrinkle::JointDesc;
using wrinkle::kNoJoint;
using wrinkle::Transform;

constexpr std::size_t kMaxNodes = 16384;

std::string NodeAt(std::size_t node) { return "nodes[" + std::to_string(node) + "]"; }

bool IsFinite(const glm::mat4& m) {
  const float* values = glm::value_ptr(m);
  return std::all_of(values, values + 16, [](float v) { return std::isfinite(v); });
}

// Parents of all nodes; a node has at most one, and nobody is above themselves.
Status FindParents(const tinygltf::Model& model, std::vector<int>* parents) {
  const auto count = static_cast<int>(model.nodes.size());
  if (model.nodes.size() > kMaxNodes) {
    return {StatusCode::kLimit, "more than " + std::to_string(kMaxNodes) + " nodes", "nodes"};
  }
  parents->assign(model.nodes.size(), -1);
  for (int node = 0; node < count; ++node) {
    for (const int child : model.nodes[node].children) {
      const std::string where = NodeAt(static_cast<std::size_t>(node)) + ".children";
      if (child < 0 || child >= count) {
        return {StatusCode::kSchema, "there is no node " + std::to_string(child), where};
      }
      if ((*parents)[child] >= 0) {
        return {StatusCode::kCyclic, "node " + std::to_string(child) + " has two parents", where};
      }
      (*parents)[child] = node;
    }
  }
  for (int node = 0; node < count; ++node) {
    int steps = 0;
    for (int above = (*parents)[node]; above >= 0; above = (*parents)[above]) {
      if (++steps > count) {
        return {StatusCode::kCyclic, "the node is below itself",
                NodeAt(static_cast<std::size_t>(node)) + ".children"};
      }
    }
  }
  return {};
}

Status FromMatrix(const std::vector<double>& values, const std::string& where,
                  Transform* transform) {
  glm::mat4 m;
  for (int i = 0; i < 16; ++i) glm::value_ptr(m)[i] = static_cast<float>(values[i]);
  if (!IsFinite(m)) return {StatusCode::kNonFinite, "the matrix is not finite", where};
  glm::mat3 axes(m);
  for (int i = 0; i < 3; ++i) {
    transform->scale[i] = glm::length(axes[i]);
    if (transform->scale[i] < 1e-9f) {
      return {StatusCode::kUnsupported, "the matrix is flat", where};
    }
    axes[i] /= transform->scale[i];
  }
  if (glm::determinant(axes) < 0.0f) {
    transform->scale.x = -transform->scale.x;
    axes[0] = -axes[0];
  }
  const float shear =
      std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[0], axes[2])),
                std::abs(glm::dot(axes[1], axes[2]))});
  if (shear > 1e-3f) return {StatusCode::kUnsupported, "the matrix shears", where};
  transform->rotation = glm::normalize(glm::quat_cast(axes));
  transform->translation = glm::vec3(m[3]);
  return {};
}

Status ReadTransform(const tinygltf::Node& node, const std::string& at, Transform* to) {
  if (node.matrix.size() == 16) return FromMatrix(node.matrix, at + ".matrix", to);
  const auto number = [](double v) { return static_cast<float>(v); };
  const auto bad_size = [&](const std::vector<double>& v, std::size_t size) {
    return !v.empty() && v.size() != size;
  };
  if (bad_size(node.matrix, 16)) return {StatusCode::kSchema, "16 numbers are due", at + ".matrix"};
  if (bad_size(node.translation, 3)) {
    return {StatusCode::kSchema, "3 numbers are due", at + ".translation"};
  }
  if (bad_size(node.rotation, 4))
    return {StatusCode::kSchema, "4 numbers are due", at + ".rotation"};
  if (bad_size(node.scale, 3)) return {StatusCode::kSchema, "3 numbers are due", at + ".scale"};
  for (std::size_t i = 0; i < node.translation.size(); ++i) {
    to->translation[static_cast<int>(i)] = number(node.translation[i]);
  }
  for (std::size_t i = 0; i < node.scale.size(); ++i) {
    to->scale[static_cast<int>(i)] = number(node.scale[i]);
  }
  if (node.rotation.size() == 4) {
    const auto& r = node.rotation;
    to->rotation = glm::quat(number(r[3]), number(r[0]), number(r[1]), number(r[2]));
    const float length = glm::length(to->rotation);
    // Exactly as written where it is a unit, so that what we wrote reads back equal.
    if (std::abs(length - 1.0f) > 1e-6f && length > 1e-6f && std::isfinite(length)) {
      to->rotation = to->rotation / length;
    }
  }
  if (wrinkle::IsValid(*to)) return {};
  return {StatusCode::kNonFinite, "the transform is not finite, or its rotation has no length", at};
}

std::optional<glm::vec3> ReadTail(const tinygltf::Node& node) {
  if (!node.extras.IsObject() || !node.extras.Has("furrow_tail")) return std::nullopt;
  const tinygltf::Value& tail = node.extras.Get("furrow_tail");
  if (!tail.IsArray() || tail.ArrayLen() != 3) return std::nullopt;
  glm::vec3 v(0.0f);
  for (int i = 0; i < 3; ++i) {
    const tinygltf::Value& number = tail.Get(i);
    if (!number.IsNumber()) return std::nullopt;
    v[i] = static_cast<float>(number.GetNumberAsDouble());
  }
  return v;
}

// Which nodes become joints.
Status ChooseJoints(const tinygltf::Model& model, const std::vector<int>& parents,
                    std::vector<bool>* chosen) {
  chosen->assign(model.nodes.size(), model.skins.empty());
  for (std::size_t s = 0; s < model.skins.size(); ++s) {
    const std::string where = "skins[" + std::to_string(s) + "].joints";
    if (model.skins[s].joints.empty()) return {StatusCode::kSchema, "a skin needs a joint", where};
    for (const int joint : model.skins[s].joints) {
      if (joint < 0 || joint >= static_cast<int>(model.nodes.size())) {
        return {StatusCode::kSchema, "there is no node " + std::to_string(joint), where};
      }
      for (int node = joint; node >= 0 && !(*chosen)[node]; node = parents[node]) {
        (*chosen)[node] = true;
      }
    }
  }
  return {};
}

// Inverse bind matrices of all skins, each joint's once.
Status ReadInverseBind(const tinygltf::Model& model, GltfSkeleton* to) {
  std::vector<bool> stated(to->inverse_bind_matrices.size(), false);
  for (std::size_t s = 0; s < model.skins.size(); ++s) {
    const tinygltf::Skin& skin = model.skins[s];
    const std::string where = "skins[" + std::to_string(s) + "].inverseBindMatrices";
    std::optional<GltfAccessor> matrices;
    if (skin.inverseBindMatrices >= 0) {
      Result<GltfAccessor> accessor =
          GltfAccessor::Create(model, skin.inverseBindMatrices, 16, where);
      FURROW_RETURN_IF_ERROR(accessor);
      if (accessor->size() < skin.joints.size()) {
        return {StatusCode::kSchema, "fewer matrices than joints", where};
      }
      matrices = *accessor;
    }
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      glm::mat4 m(1.0f);
      for (int k = 0; matrices && k < 16; ++k) glm::value_ptr(m)[k] = matrices->Float(i, k);
      if (!IsFinite(m)) {
        return {StatusCode::kNonFinite, "matrix " + std::to_string(i) + " is not finite", where};
      }
      const int joint = to->exact_joint[skin.joints[i]];
      glm::mat4& known = to->inverse_bind_matrices[joint];
      for (int k = 0; stated[joint] && k < 16; ++k) {
        const float a = glm::value_ptr(known)[k];
        const float b = glm::value_ptr(m)[k];
        if (std::abs(a - b) > 1e-3f * (1.0f + std::abs(a))) {
          return {StatusCode::kUnsupported,
                  "two skins bind joint '" + to->skeleton.joint_names()[joint] + "' differently",
                  where, "apply the mesh transforms before exporting"};
        }
      }
      if (!stated[joint]) known = m;
      stated[joint] = true;
    }
  }
  return {};
}

}  // namespace

Result<GltfSkeleton> ReadGltfSkeleton(const tinygltf::Model& model) {
  GltfSkeleton to;
  std::vector<int> parents;
  std::vector<bool> chosen;
  if (model.nodes.empty()) return Status(StatusCode::kSchema, "there are no nodes", "nodes");
  FURROW_RETURN_IF_ERROR(FindParents(model, &parents));
  FURROW_RETURN_IF_ERROR(ChooseJoints(model, parents, &chosen));

  const std::size_t count = model.nodes.size();
  std::vector<Transform> locals(count);
  std::vector<JointDesc> joints;
  std::vector<int> joint_index(count, kNoJoint);
  for (std::size_t node = 0; node < count; ++node) {
    FURROW_RETURN_IF_ERROR(ReadTransform(model.nodes[node], NodeAt(node), &locals[node]));
    if (!chosen[node]) continue;
    joint_index[node] = static_cast<int>(joints.size());
    const std::string& name = model.nodes[node].name;
    to.nameless_joints += name.empty() ? 1 : 0;
    joints.push_back({name.empty() ? "node_" + std::to_string(node) : name, kNoJoint, locals[node],
                      ReadTail(model.nodes[node])});
  }
  for (std::size_t node = 0; node < count; ++node) {
    if (chosen[node] && parents[node] >= 0) {
      joints[joint_index[node]].parent = joint_index[parents[node]];
    }
  }
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
  if (!skeleton.ok()) return skeleton.status().At("nodes");
  to.skeleton = std::move(*skeleton);

  std::vector<int> sorted(static_cast<std::size_t>(to.skeleton.num_joints()));
  for (int j = 0; j < to.skeleton.num_joints(); ++j) sorted[to.skeleton.source_index()[j]] = j;
  to.exact_joint.assign(count, kNoJoint);
  to.joint_of_node.assign(count, 0);
  to.node_model.assign(count, glm::mat4(1.0f));
  for (std::size_t node = 0; node < count; ++node) {
    if (chosen[node]) to.exact_joint[node] = sorted[joint_index[node]];
    bool found = false;
    for (int above = static_cast<int>(node); above >= 0; above = parents[above]) {
      to.node_model[node] = wrinkle::ToMatrix(locals[above]) * to.node_model[node];
      if (!found && chosen[above]) to.joint_of_node[node] = sorted[joint_index[above]];
      found = found || chosen[above];
    }
  }
  for (const glm::mat4& rest : to.skeleton.rest_model()) {
    to.inverse_bind_matrices.push_back(glm::inverse(rest));
  }
  FURROW_RETURN_IF_ERROR(ReadInverseBind(model, &to));
  return to;
}

}  // namespace furrow::character
