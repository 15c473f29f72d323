// SPDX-License-Identifier: Apache-2.0
#include "gltf/write/scene_json.h"

#include <cstddef>
#include <utility>

namespace furrow::gltf {

using Json = Builder::Json;

Json ToJson(const glm::vec3& v) { return {v.x, v.y, v.z}; }
Json ToJson(const glm::quat& q) { return {q.x, q.y, q.z, q.w}; }

Json NodeJson(const std::string& name, const Transform& local) {
  Json node = {{"name", name}};
  node["translation"] = ToJson(local.translation);
  if (local.rotation != glm::quat(1.0f, 0.0f, 0.0f, 0.0f)) {
    node["rotation"] = ToJson(local.rotation);
  }
  if (local.scale != glm::vec3(1.0f)) node["scale"] = ToJson(local.scale);
  return node;
}

void AddJointNodes(std::span<const Joint> joints, Json* nodes, Json* roots) {
  // Children are stated at the parent, so they are collected before any node is written.
  std::vector<Json> children(joints.size(), Json::array());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int parent = joints[j].parent;
    (parent == kNone ? *roots : children[static_cast<std::size_t>(parent)]).push_back(j);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    Json node = NodeJson(joints[j].name, joints[j].rest);
    if (!children[j].empty()) node["children"] = std::move(children[j]);
    if (joints[j].tail) node["extras"][kTailExtra] = ToJson(*joints[j].tail);
    if (!joints[j].role.empty()) node["extras"][kRoleExtra] = joints[j].role;
    nodes->push_back(std::move(node));
  }
}

}  // namespace furrow::gltf
