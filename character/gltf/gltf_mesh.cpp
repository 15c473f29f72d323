// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

#include "base/status.h"
#include "character/gltf/gltf_morph_targets.h"
#include "character/mesh/faint_shapes.h"
#include "character/mesh/move_mesh.h"
#include "character/mesh/spread_influences.h"
#include "character/mesh/tangents.h"
#include "character/source_notes.h"
#include "gltf/document/accessor.h"
#include "gltf/limits.h"
#include "gltf/scene/meshes.h"

namespace furrow::character {
namespace {

using gltf::Accessor;
using gltf::ElementType;

// Converts one primitive to a Mesh.
class PrimitiveReader {
 public:
  PrimitiveReader(const gltf::Document& document, const gltf::Primitive& primitive, std::string at,
                  bool lenient, Mesh* mesh, MeshNotes* notes)
      : document_(document),
        primitive_(primitive),
        at_(std::move(at)),
        lenient_(lenient),
        mesh_(mesh),
        notes_(notes) {}

  // `uv_set`: n of TEXCOORD_n.
  Status ReadGeometry(int uv_set, const gltf::UvTransform& uv_transform) {
    std::optional<Accessor> position, normal, tangent, uv;
    FURROW_RETURN_IF_ERROR(Attribute("POSITION", ElementType::kVec3, true, &position));
    if (position->size() > gltf::kMaxVertices)
      return {StatusCode::kLimit, "too many vertices", at_};
    mesh_->vertices.resize(position->size());
    FURROW_RETURN_IF_ERROR(Attribute("NORMAL", ElementType::kVec3, false, &normal));
    FURROW_RETURN_IF_ERROR(Attribute("TANGENT", ElementType::kVec4, false, &tangent));
    const std::string uv_name = UvName(uv_set);
    FURROW_RETURN_IF_ERROR(Attribute(uv_name, ElementType::kVec2, false, &uv));
    notes_->has_uvs = uv.has_value();
    notes_->has_normals = normal.has_value();
    notes_->has_tangents = tangent.has_value();
    notes_->morph_targets = static_cast<int>(primitive_.morph_targets.size());
    const bool transformed = uv_transform != gltf::UvTransform();
    // One unusable vector discards the attribute of the whole mesh: mixing stated and computed
    // vectors would show as a seam.
    bool normals_usable = normal.has_value();
    bool tangents_usable = tangent.has_value();
    for (std::size_t v = 0; v < mesh_->vertices.size(); ++v) {
      Vertex& vertex = mesh_->vertices[v];
      FURROW_RETURN_IF_ERROR(Vector(*position, v, "POSITION", &vertex.position));
      if (uv) {
        FURROW_RETURN_IF_ERROR(Vector(*uv, v, uv_name, &vertex.uv));
        if (transformed) vertex.uv = uv_transform.Apply(vertex.uv);
      }
      if (normal) {
        FURROW_RETURN_IF_ERROR(Vector(*normal, v, "NORMAL", &vertex.normal));
        normals_usable = normals_usable && MakeUnit(&vertex.normal);
      }
      if (tangent) {
        FURROW_RETURN_IF_ERROR(Vector(*tangent, v, "TANGENT", &vertex.tangent));
        glm::vec3 direction(vertex.tangent);
        tangents_usable = tangents_usable && MakeUnit(&direction);
        // w is the sign of the bitangent.
        vertex.tangent = glm::vec4(direction, vertex.tangent.w < 0.0f ? -1.0f : 1.0f);
      }
    }
    FURROW_RETURN_IF_ERROR(ReadIndices());
    // Tangents are orthogonal to normals, so new normals need new tangents.
    if (!normals_usable) paint::ComputeNormals(mesh_->vertices, mesh_->indices);
    if (!tangents_usable || !normals_usable)
      paint::ComputeTangents(mesh_->vertices, mesh_->indices);
    base_ = {normals_usable, normals_usable && tangents_usable};
    return {};
  }

  Status ReadMorphTargets(const gltf::Mesh& from, GltfMorphTargets* targets) {
    return targets->Read(from, primitive_, at_, base_, mesh_);
  }

  // `joint_of`: from index in the skin's list to joint of the skeleton.
  Status ReadInfluences(const std::vector<int>& joint_of) {
    notes_->skinned = true;
    std::vector<bool> unskinned(mesh_->vertices.size(), false);
    std::vector<std::pair<std::optional<Accessor>, std::optional<Accessor>>> sets;
    for (int set = 0; set < gltf::kMaxInfluenceSets; ++set) {
      const std::string suffix = "_" + std::to_string(set);
      auto& [joints, weights] = sets.emplace_back();
      FURROW_RETURN_IF_ERROR(Attribute("JOINTS" + suffix, ElementType::kVec4, set == 0, &joints));
      FURROW_RETURN_IF_ERROR(
          Attribute("WEIGHTS" + suffix, ElementType::kVec4, joints.has_value(), &weights));
      if (joints && !joints->is_unsigned()) {
        return {StatusCode::kSchema, "expected an array of unsigned integers",
                Field("JOINTS" + suffix)};
      }
      if (!joints) {
        sets.pop_back();
        break;
      }
    }
    // Weights of 0 are padding. Their joints may be anything, so they are skipped before the check.
    for (std::size_t v = 0; v < mesh_->vertices.size(); ++v) {
      std::vector<std::pair<float, int>> influences;
      for (std::size_t set = 0; set < sets.size(); ++set) {
        for (int i = 0; i < 4; ++i) {
          const float weight = sets[set].second->Float(v, i);
          const std::uint32_t joint = sets[set].first->Unsigned(v, i);
          const std::string suffix = "_" + std::to_string(set);
          if (!std::isfinite(weight)) return NotFinite("WEIGHTS" + suffix, v);
          if (weight < 0.0f) {
            return {StatusCode::kInvalidArgument,
                    "a skin weight of vertex " + std::to_string(v) + " is negative",
                    Field("WEIGHTS" + suffix)};
          }
          if (weight == 0.0f) continue;
          if (joint >= joint_of.size()) {
            return {StatusCode::kSchema,
                    "vertex " + std::to_string(v) + " refers to joint " + std::to_string(joint) +
                        ", the skin has " + std::to_string(joint_of.size()) + " joints",
                    Field("JOINTS" + suffix)};
          }
          influences.emplace_back(weight, joint_of[joint]);
        }
      }
      if (lenient_ && influences.empty()) {
        unskinned[v] = true;
        ++notes_->unskinned_vertices;
        continue;
      }
      FURROW_RETURN_IF_ERROR(KeepStrongest(influences, v));
    }
    if (notes_->unskinned_vertices > 0) SpreadInfluences(unskinned, joint_of.front(), mesh_);
    return {};
  }

  void FollowJoint(int joint) {
    for (Vertex& vertex : mesh_->vertices) {
      vertex.joints[0] = static_cast<std::uint16_t>(joint);
    }
  }

 private:
  // Primitives without the wanted set have their first one at best.
  [[nodiscard]] std::string UvName(int uv_set) const {
    const std::string wanted = "TEXCOORD_" + std::to_string(uv_set);
    return primitive_.attributes.count(wanted) > 0 ? wanted : "TEXCOORD_0";
  }

  [[nodiscard]] std::string Field(const std::string& name) const {
    return at_ + ".attributes." + name;
  }

  Status NotFinite(const std::string& name, std::size_t vertex) const {
    return {StatusCode::kNonFinite, "vertex " + std::to_string(vertex) + " is not finite",
            Field(name)};
  }

  static bool MakeUnit(glm::vec3* v) {
    const float length = glm::length(*v);
    if (!(length > 1e-6f)) return false;
    if (std::abs(length - 1.0f) > 1e-6f) *v /= length;  // keeps the bits of a unit vector
    return true;
  }

  Status Attribute(const std::string& name, ElementType type, bool required,
                   std::optional<Accessor>* accessor) const {
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end()) {
      if (!required) return {};
      return {StatusCode::kSchema, "the attribute is missing", Field(name)};
    }
    const Result<Accessor> result = Accessor::Create(document_, found->second, type, Field(name));
    FURROW_RETURN_IF_ERROR(result);
    // POSITION is read first and states the number of vertices.
    if (!mesh_->vertices.empty() && result->size() != mesh_->vertices.size()) {
      return {StatusCode::kSchema,
              std::to_string(result->size()) + " elements for " +
                  std::to_string(mesh_->vertices.size()) + " vertices",
              Field(name)};
    }
    *accessor = *result;
    return {};
  }

  template <class V>
  Status Vector(const Accessor& accessor, std::size_t vertex, const std::string& name,
                V* to) const {
    for (int i = 0; i < V::length(); ++i) {
      (*to)[i] = accessor.Float(vertex, i);
      if (!std::isfinite((*to)[i])) return NotFinite(name, vertex);
    }
    return {};
  }

  Status ReadIndices() {
    const std::string where = at_ + ".indices";
    const std::size_t num_vertices = mesh_->vertices.size();
    if (primitive_.indices < 0) {
      for (std::size_t i = 0; i < num_vertices; ++i) {
        mesh_->indices.push_back(static_cast<std::uint32_t>(i));
      }
    } else {
      const Result<Accessor> indices =
          Accessor::Create(document_, primitive_.indices, ElementType::kScalar, where);
      FURROW_RETURN_IF_ERROR(indices);
      if (!indices->is_unsigned())
        return {StatusCode::kSchema, "expected an array of unsigned integers", where};
      if (indices->size() > gltf::kMaxIndices)
        return {StatusCode::kLimit, "too many indices", where};
      mesh_->indices.resize(indices->size());
      for (std::size_t i = 0; i < indices->size(); ++i) {
        const std::uint32_t index = indices->Unsigned(i);
        if (index >= num_vertices) {
          return {StatusCode::kSchema,
                  "index " + std::to_string(index) + " is out of range, there are " +
                      std::to_string(num_vertices) + " vertices",
                  where};
        }
        mesh_->indices[i] = index;
      }
    }
    if (primitive_.kind != gltf::PrimitiveKind::kTriangles) MakeTriangles();
    if (mesh_->indices.size() % 3 == 0) return {};
    return {StatusCode::kSchema, "the number of indices is not a multiple of 3", where};
  }

  // Writes a strip or a fan as triangles. Every second triangle of a strip turns the other way.
  void MakeTriangles() {
    const std::vector<std::uint32_t> from = std::exchange(mesh_->indices, {});
    for (std::size_t i = 2; i < from.size(); ++i) {
      const bool fan = primitive_.kind == gltf::PrimitiveKind::kFan;
      const std::uint32_t first = from[fan ? 0 : i - 2];
      const bool turned = !fan && i % 2 == 1;
      for (const std::uint32_t index :
           {first, from[turned ? i : i - 1], from[turned ? i - 1 : i]}) {
        mesh_->indices.push_back(index);
      }
    }
  }

  // Keeps the strongest four influences of a vertex and scales their sum to 1.
  Status KeepStrongest(std::vector<std::pair<float, int>>& influences, std::size_t v) {
    std::stable_sort(influences.begin(), influences.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    NoteSum(influences);
    influences.resize(std::min<std::size_t>(influences.size(), 4));
    float sum = 0.0f;
    for (const auto& [weight, joint] : influences) sum += weight;
    if (!(sum > 0.0f) || !std::isfinite(sum)) {
      return {StatusCode::kInvalidArgument,
              "the skin weights of vertex " + std::to_string(v) + " sum to 0", Field("WEIGHTS_0"),
              "bind every vertex to a joint"};
    }
    // Sums near 1 stay as they are, so that writing and reading a file keeps its bits.
    const bool unit = std::abs(sum - 1.0f) <= 1e-6f;
    Vertex& vertex = mesh_->vertices[v];
    for (std::size_t i = 0; i < 4; ++i) {
      const bool used = i < influences.size();
      vertex.joints[i] = static_cast<std::uint16_t>(used ? influences[i].second : 0);
      vertex.skin_weights[i] = used ? influences[i].first / (unit ? 1.0f : sum) : 0.0f;
    }
    return {};
  }

  // Records what KeepStrongest() is about to change.
  void NoteSum(const std::vector<std::pair<float, int>>& influences) {
    constexpr float kTolerance = 0.01f;  // above the rounding error of weights stored as bytes
    float sum = 0.0f;
    for (const auto& [weight, joint] : influences) sum += weight;
    notes_->truncated_vertices += influences.size() > 4 ? 1 : 0;
    if (std::abs(sum - 1.0f) <= kTolerance) return;
    ++notes_->unnormalised_vertices;
    if (std::abs(sum - 1.0f) > std::abs(notes_->worst_sum - 1.0f)) notes_->worst_sum = sum;
  }

  const gltf::Document& document_;
  const gltf::Primitive& primitive_;
  std::string at_;
  bool lenient_;
  Mesh* mesh_;
  MeshNotes* notes_;
  GltfMorphTargets::Base base_;
};

// Moves a skinned mesh to model space.
void ApplySkinMoves(const std::vector<int>& joints, const std::vector<glm::mat4>& moves,
                    Mesh* mesh) {
  if (moves.empty()) return;
  std::unordered_map<int, const glm::mat4*> move_of;
  for (std::size_t i = 0; i < joints.size(); ++i) move_of.try_emplace(joints[i], &moves[i]);
  MoveMesh(
      [&](const Vertex& vertex) {
        glm::mat4 sum(0.0f);
        for (int i = 0; i < 4; ++i) {
          const float weight = vertex.skin_weights[i];
          if (weight > 0.0f) sum += *move_of.at(vertex.joints[i]) * weight;
        }
        return sum;
      },
      mesh);
}

// What all meshes of a file share.
struct Source {
  gltf::Document& document;
  const GltfSkeleton& skeleton;
  const std::vector<gltf::Material>& materials;
  bool lenient;
};

// `n`: the index of `node`.
Status ReadNode(const Source& source, const gltf::Mesh& from, const gltf::Node& node, std::size_t n,
                GltfMorphTargets* targets, std::vector<Mesh>* meshes,
                std::vector<MeshNotes>* notes) {
  const GltfSkeleton& skeleton = source.skeleton;
  for (std::size_t p = 0; p < from.primitives.size(); ++p) {
    const gltf::Primitive& primitive = from.primitives[p];
    const std::string where =
        "meshes[" + std::to_string(node.mesh) + "].primitives[" + std::to_string(p) + "]";
    if (primitive.kind == gltf::PrimitiveKind::kOther) {
      source.document.Warn(where + ".mode",
                           "points and lines are left out; only triangles are drawn");
      continue;
    }
    Mesh& mesh = meshes->emplace_back();
    mesh.name = from.name;
    if (from.primitives.size() > 1) mesh.name += "_" + std::to_string(p);
    mesh.material = primitive.material;
    PrimitiveReader reader(source.document, primitive, where, source.lenient, &mesh,
                           &notes->emplace_back());
    gltf::UvTransform uv_transform;
    int uv_set = 0;
    if (mesh.material >= 0) {
      const gltf::Material& material = source.materials[static_cast<std::size_t>(mesh.material)];
      uv_set = material.uv_set;
      if (!material.is_atlas_tile) uv_transform = material.uv_transform;
    }
    FURROW_RETURN_IF_ERROR(reader.ReadGeometry(uv_set, uv_transform));
    FURROW_RETURN_IF_ERROR(reader.ReadMorphTargets(from, targets));
    if (node.skin != gltf::kNone) {
      const auto skin = static_cast<std::size_t>(node.skin);
      FURROW_RETURN_IF_ERROR(reader.ReadInfluences(skeleton.skin_joints[skin]));
      ApplySkinMoves(skeleton.skin_joints[skin], skeleton.skin_moves[skin], &mesh);
    } else {
      // Moves the mesh to model space in the rest pose.
      MoveMesh([&](const Vertex&) { return skeleton.node_model[n]; }, &mesh);
      reader.FollowJoint(skeleton.joint_of_node[n]);
    }
  }
  return {};
}

}  // namespace

Result<GltfMeshes> ReadGltfMeshes(gltf::Document* document, const gltf::NodeForest& forest,
                                  const GltfSkeleton& skeleton,
                                  const std::vector<gltf::Material>& materials,
                                  const ReadOptions& options) {
  const Result<std::vector<gltf::Mesh>> from = gltf::ReadMeshes(document);
  FURROW_RETURN_IF_ERROR(from);
  const Source source{*document, skeleton, materials, options.lenient};
  GltfMorphTargets targets(*document);
  std::vector<Mesh> meshes;
  std::vector<MeshNotes> notes;
  std::size_t vertices = 0;
  std::size_t indices = 0;
  for (std::size_t n = 0; n < forest.nodes.size(); ++n) {
    const gltf::Node& node = forest.nodes[n];
    if (node.mesh == gltf::kNone) continue;
    const std::size_t before = meshes.size();
    FURROW_RETURN_IF_ERROR(ReadNode(source, (*from)[static_cast<std::size_t>(node.mesh)], node, n,
                                    &targets, &meshes, &notes));
    for (std::size_t m = before; m < meshes.size(); ++m) {
      vertices += meshes[m].vertices.size();
      indices += meshes[m].indices.size();
    }
    // Many nodes may share one mesh, so the sum needs a limit as well.
    if (vertices > gltf::kMaxVertices || indices > gltf::kMaxIndices) {
      return Status(StatusCode::kLimit,
                    "the meshes have more than " + std::to_string(gltf::kMaxVertices) +
                        " vertices or " + std::to_string(gltf::kMaxIndices) + " indices together",
                    "meshes", "reduce the meshes, or the number of nodes that use them");
    }
  }
  if (meshes.empty()) {
    return Status(StatusCode::kSchema, "no node has a mesh of triangles", "nodes",
                  "export the character with its meshes as polygons");
  }
  if (targets.num_surplus() > 0) {
    document->Warn("meshes", "the meshes have more than " + std::to_string(kMaxShapes) +
                                 " shapes; left out: " + std::to_string(targets.num_surplus()));
  }
  std::vector<std::string> shapes = targets.names();
  std::vector<std::string> idle = targets.idle_names();
  for (std::string& name : DropFaintShapes(&shapes, &meshes)) idle.push_back(std::move(name));
  if (options.notes != nullptr) {
    options.notes->meshes = std::move(notes);
    options.notes->idle_shapes = std::move(idle);
  }
  return GltfMeshes{std::move(meshes), std::move(shapes)};
}

}  // namespace furrow::character
