// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/meshes.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <tiny_gltf.h>

#include "base/ascii.h"
#include "base/status.h"
#include "base/text.h"
#include "gltf/limits.h"
#include "gltf/scene/vrm_expressions.h"

namespace furrow::gltf {
namespace {

// Names that tell the targets of one mesh apart. FBX converters repeat a name for each in-between.
std::vector<std::string> UniqueTargetNames(int mesh, Document* document) {
  std::vector<std::string> names = document->MorphTargetNames(mesh);
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, int> next_number;  // keeps many equal names linear
  std::size_t repeated = 0;
  for (std::string& name : names) {
    name = CutText(name, kMaxNameBytes);
    const std::string base = name;
    int& number = next_number.try_emplace(base, 2).first->second;
    while (!taken.insert(name).second) name = base + "_" + std::to_string(number++);
    repeated += name != base ? 1 : 0;
  }
  if (repeated > 0) {
    document->Warn("meshes[" + std::to_string(mesh) + "].extras.targetNames",
                   Counted(repeated, "morph target repeats", "morph targets repeat") +
                       " a name of the mesh; a number is appended");
  }
  return names;
}

int FindAccessor(const std::map<std::string, int>& attributes, const char* name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? kNone : found->second;
}

PrimitiveKind KindOf(int mode) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES: return PrimitiveKind::kTriangles;
    case TINYGLTF_MODE_TRIANGLE_STRIP: return PrimitiveKind::kStrip;
    case TINYGLTF_MODE_TRIANGLE_FAN: return PrimitiveKind::kFan;
    default: return PrimitiveKind::kOther;
  }
}

Primitive ReadPrimitive(const tinygltf::Primitive& from, std::size_t num_names) {
  Primitive to{KindOf(from.mode), from.attributes, from.indices, from.material, {}};
  for (const std::map<std::string, int>& target : from.targets) {
    if (to.morph_targets.size() == num_names) break;
    to.morph_targets.push_back({FindAccessor(target, "POSITION"), FindAccessor(target, "NORMAL"),
                                FindAccessor(target, "TANGENT")});
  }
  return to;
}

void AddMixes(std::span<const VrmExpression> expressions, std::vector<Mesh>* meshes) {
  std::unordered_set<std::string> taken;
  for (const Mesh& mesh : *meshes) {
    for (const std::string& name : mesh.morph_target_names) taken.insert(AsciiLower(name));
  }
  for (const VrmExpression& expression : expressions) {
    if (!taken.insert(AsciiLower(expression.name)).second) continue;
    for (const VrmExpression::Bind& bind : expression.binds) {
      std::vector<MorphMix>& mixes = (*meshes)[static_cast<std::size_t>(bind.mesh)].mixes;
      if (mixes.empty() || mixes.back().name != expression.name) {
        mixes.push_back({expression.name, {}});
      }
      mixes.back().targets.emplace_back(bind.target, bind.weight);
    }
  }
}

// By index. Optimisers drop the names of meshes and keep those of nodes, or hang the mesh below a
// node that keeps the name.
std::vector<std::string> MeshNames(const tinygltf::Model& model) {
  std::vector<std::string> names;
  for (const tinygltf::Mesh& mesh : model.meshes) names.push_back(mesh.name);
  const auto name_by = [&](int node, const std::string& name) {
    if (node < 0 || static_cast<std::size_t>(node) >= model.nodes.size()) return;
    const int mesh = model.nodes[static_cast<std::size_t>(node)].mesh;
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= names.size()) return;
    std::string& known = names[static_cast<std::size_t>(mesh)];
    if (known.empty()) known = name.substr(0, kMaxNameBytes);
  };
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    name_by(static_cast<int>(i), model.nodes[i].name);
  }
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) name_by(child, node.name);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) names[i] = "mesh_" + std::to_string(i);
  }
  return names;
}

// Grows `bounds` by one primitive. Returns false if the primitive states no usable bounds.
bool Grow(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
          const glm::mat4& placement, Bounds* bounds) {
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end() || position->second < 0 ||
      static_cast<std::size_t>(position->second) >= model.accessors.size()) {
    return false;
  }
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(position->second)];
  if (accessor.normalized || accessor.minValues.size() != 3 || accessor.maxValues.size() != 3) {
    return false;
  }
  for (int corner = 0; corner < 8; ++corner) {
    glm::vec4 place(1.0f);
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double>& side =
          (corner >> axis & 1) == 0 ? accessor.minValues : accessor.maxValues;
      place[axis] = static_cast<float>(side[static_cast<std::size_t>(axis)]);
    }
    const glm::vec3 placed(placement * place);
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(placed[axis])) return false;
    }
    bounds->low = glm::min(bounds->low, placed);
    bounds->high = glm::max(bounds->high, placed);
  }
  return true;
}

}  // namespace

Result<std::vector<Mesh>> ReadMeshes(Document* document) {
  const tinygltf::Model& model = document->model();
  const std::vector<std::string> names = MeshNames(model);
  std::vector<Mesh> meshes;
  for (const tinygltf::Mesh& from : model.meshes) {
    const std::string index = std::to_string(meshes.size());
    Mesh& mesh = meshes.emplace_back();
    mesh.name = names[meshes.size() - 1];
    mesh.morph_target_names = UniqueTargetNames(static_cast<int>(meshes.size()) - 1, document);
    for (const tinygltf::Primitive& part : from.primitives) {
      if (part.material < kNone || part.material >= static_cast<int>(model.materials.size())) {
        return Status(StatusCode::kSchema,
                      "material " + std::to_string(part.material) + " does not exist",
                      "meshes[" + index + "].primitives[" + std::to_string(mesh.primitives.size()) +
                          "].material");
      }
      mesh.primitives.push_back(ReadPrimitive(part, mesh.morph_target_names.size()));
    }
  }
  const auto expressions = ReadVrmExpressions(document);
  FURROW_RETURN_IF_ERROR(expressions);
  AddMixes(*expressions, &meshes);
  return meshes;
}

std::optional<Bounds> BoundsOfPart(const Document& document, const NodeForest& forest, int node) {
  const tinygltf::Model& model = document.model();
  Bounds bounds{glm::vec3(std::numeric_limits<float>::max()),
                glm::vec3(std::numeric_limits<float>::lowest())};
  std::vector<std::pair<int, glm::mat4>> open = {{node, glm::mat4(1.0f)}};
  bool has_any = false;
  while (!open.empty()) {
    const auto [index, placement] = open.back();
    open.pop_back();
    const Node& from = forest.nodes[static_cast<std::size_t>(index)];
    const bool is_rigid = from.mesh != kNone && from.skin == kNone;
    if (is_rigid && static_cast<std::size_t>(from.mesh) < model.meshes.size()) {
      for (const auto& primitive : model.meshes[static_cast<std::size_t>(from.mesh)].primitives) {
        if (!Grow(model, primitive, placement, &bounds)) return std::nullopt;
        has_any = true;
      }
    }
    for (const int child : from.children) {
      const Node& below = forest.nodes[static_cast<std::size_t>(child)];
      open.emplace_back(child, placement * ToMatrix(below.local));
    }
  }
  if (!has_any) return std::nullopt;
  return bounds;
}

}  // namespace furrow::gltf
