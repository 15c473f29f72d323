// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_writer.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

#include "base/status.h"
#include "character/gltf/gltf_material.h"
#include "character/gltf/gltf_material_binds.h"
#include "character/gltf/gltf_shape_rules.h"
#include "character/pictures/picture_file.h"
#include "gltf/scene/expression_rules.h"
#include "gltf/scene/joints.h"
#include "gltf/scene/material_binds.h"
#include "gltf/scene/materials.h"
#include "gltf/write/builder.h"
#include "gltf/write/scene_json.h"

namespace furrow::character {
namespace {

using gltf::Builder;
using Json = Builder::Json;

class CharacterWriter {
 public:
  explicit CharacterWriter(const Character& character) : character_(character) {}

  Result<std::string> Run() {
    FURROW_RETURN_IF_ERROR(CheckSizes());
    AddNodes();
    AddSkin();
    for (const Mesh& mesh : character_.meshes) AddMesh(mesh);
    AddMaterials();
    for (const Picture& picture : character_.pictures) {
      FURROW_RETURN_IF_ERROR(AddPicture(picture));
    }
    return builder_.Finish();
  }

 private:
  // Everything that the writer indexes by, so that an inconsistent character cannot make an invalid
  // file.
  Status CheckSizes() const {
    const int joints = character_.skeleton.num_joints();
    if (joints == 0)
      return {StatusCode::kInvalidArgument, "the character has no joints", "skeleton"};
    if (static_cast<int>(character_.inverse_bind_matrices.size()) != joints) {
      return {StatusCode::kInvalidArgument, "expected one matrix per joint",
              "inverse_bind_matrices"};
    }
    if (!character_.roles.empty() && static_cast<int>(character_.roles.size()) != joints) {
      return {StatusCode::kInvalidArgument, "expected one role per joint", "roles"};
    }
    if (character_.meshes.empty()) {
      return {StatusCode::kInvalidArgument, "the character has no mesh", "meshes"};
    }
    for (const Mesh& mesh : character_.meshes) {
      FURROW_RETURN_IF_ERROR(CheckMesh(mesh));
    }
    const auto pictures = static_cast<int>(character_.pictures.size());
    for (const Material& m : character_.materials) {
      if (std::max({m.base_colour_texture, m.normal_texture, m.roughness_texture,
                    m.emission_texture, m.thickness_texture}) >= pictures) {
        return {StatusCode::kInvalidArgument,
                "material '" + m.name + "' refers to a picture that does not exist", "materials"};
      }
    }
    return {};
  }

  Status CheckMesh(const Mesh& mesh) const {
    const std::string where = "meshes '" + mesh.name + "'";
    if (mesh.vertices.empty() || mesh.indices.empty() || mesh.indices.size() % 3 != 0) {
      return {StatusCode::kInvalidArgument, "the mesh has no triangles", where};
    }
    if (mesh.material >= static_cast<int>(character_.materials.size())) {
      return {StatusCode::kInvalidArgument, "the material does not exist", where + ".material"};
    }
    const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
    if (*std::max_element(mesh.indices.begin(), mesh.indices.end()) >= vertices) {
      return {StatusCode::kInvalidArgument, "an index is out of range", where + ".indices"};
    }
    const auto joints = static_cast<std::uint16_t>(character_.skeleton.num_joints());
    for (const Vertex& vertex : mesh.vertices) {
      for (const std::uint16_t joint : vertex.joints) {
        if (joint >= joints) {
          return {StatusCode::kInvalidArgument, "a joint is out of range", where + ".joints"};
        }
      }
    }
    return CheckMorphTargets(mesh, where + ".morph_targets");
  }

  // Readers require ascending indices in sparse accessors.
  Status CheckMorphTargets(const Mesh& mesh, const std::string& where) const {
    int last_shape = -1;
    for (const MorphTarget& target : mesh.morph_targets) {
      if (target.shape <= last_shape ||
          target.shape >= static_cast<int>(character_.shapes.size())) {
        return {StatusCode::kInvalidArgument, "the shapes must exist and ascend", where};
      }
      last_shape = target.shape;
      if (target.deltas.empty()) {
        return {StatusCode::kInvalidArgument, "a morph target moves nothing", where};
      }
      std::size_t next = 0;
      for (const MorphDelta& delta : target.deltas) {
        if (delta.vertex < next || delta.vertex >= mesh.vertices.size()) {
          return {StatusCode::kInvalidArgument, "the vertices must exist and ascend", where};
        }
        next = std::size_t{delta.vertex} + 1;
      }
    }
    return {};
  }

  // Joints are the first nodes, in the skeleton's order. Meshes follow.
  void AddNodes() {
    const wrinkle::Skeleton& skeleton = character_.skeleton;
    std::vector<gltf::Joint> joints;
    for (int j = 0; j < skeleton.num_joints(); ++j) {
      const auto index = static_cast<std::size_t>(j);
      const wrinkle::Transform& rest = skeleton.rest_pose()[index];
      joints.push_back({skeleton.joint_names()[index],
                        skeleton.joint_parents()[index],
                        {rest.translation, rest.rotation, rest.scale},
                        skeleton.tails()[index],
                        j,
                        RoleOf(index)});
    }
    Json nodes = Json::array();
    Json roots = Json::array();
    gltf::AddJointNodes(joints, &nodes, &roots);
    for (std::size_t m = 0; m < character_.meshes.size(); ++m) {
      roots.push_back(nodes.size());
      nodes.push_back({{"name", "mesh:" + character_.meshes[m].name}, {"mesh", m}, {"skin", 0}});
    }
    root_["scenes"] = Json::array({{{"name", character_.name}, {"nodes", std::move(roots)}}});
    if (!character_.shape_rules.empty()) {
      root_["scenes"][0]["extras"][gltf::kRulesExtra] = ShapeRulesJson(character_);
    }
    if (!character_.material_binds.empty()) {
      root_["scenes"][0]["extras"][gltf::kMaterialBindsExtra] = MaterialBindsJson(character_);
    }
    root_["nodes"] = std::move(nodes);
  }

  // Empty without a role.
  [[nodiscard]] std::string RoleOf(std::size_t joint) const {
    const bool has_role =
        !character_.roles.empty() && character_.roles[joint] != wrinkle::JointRole::kNone;
    return has_role ? std::string(wrinkle::ToString(character_.roles[joint])) : std::string();
  }

  void AddSkin() {
    const auto joints = static_cast<std::size_t>(character_.skeleton.num_joints());
    Json list = Json::array();
    for (std::size_t j = 0; j < joints; ++j) list.push_back(j);
    root_["skins"] =
        Json::array({{{"inverseBindMatrices",
                       builder_.AddAccessor(character_.inverse_bind_matrices, Builder::kFloat,
                                            "MAT4", Builder::kNoTarget)},
                      {"joints", std::move(list)}}});
  }

  void AddMesh(const Mesh& mesh) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents, weights;
    std::vector<glm::vec2> uvs;
    std::vector<glm::u16vec4> joints;
    // glTF requires min and max for positions.
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(-std::numeric_limits<float>::max());
    for (const Vertex& v : mesh.vertices) {
      positions.push_back(v.position);
      low = glm::min(low, v.position);
      high = glm::max(high, v.position);
      normals.push_back(v.normal);
      tangents.push_back(v.tangent);
      uvs.push_back(v.uv);
      weights.push_back(glm::make_vec4(v.skin_weights));
      // glTF validators expect joint 0 where the weight is 0.
      glm::u16vec4 used(0);
      for (int i = 0; i < 4; ++i) used[i] = v.skin_weights[i] > 0.0f ? v.joints[i] : 0;
      joints.push_back(used);
    }
    Json attributes;
    const int position =
        builder_.AddAccessor(positions, Builder::kFloat, "VEC3", Builder::kArrayBuffer);
    builder_.accessor(position)["min"] = gltf::ToJson(low);
    builder_.accessor(position)["max"] = gltf::ToJson(high);
    attributes["POSITION"] = position;
    attributes["NORMAL"] =
        builder_.AddAccessor(normals, Builder::kFloat, "VEC3", Builder::kArrayBuffer);
    attributes["TANGENT"] =
        builder_.AddAccessor(tangents, Builder::kFloat, "VEC4", Builder::kArrayBuffer);
    attributes["TEXCOORD_0"] =
        builder_.AddAccessor(uvs, Builder::kFloat, "VEC2", Builder::kArrayBuffer);
    attributes["JOINTS_0"] = AddJoints(joints);
    attributes["WEIGHTS_0"] =
        builder_.AddAccessor(weights, Builder::kFloat, "VEC4", Builder::kArrayBuffer);
    Json primitive = {{"attributes", std::move(attributes)}, {"indices", AddIndices(mesh)}};
    if (mesh.material >= 0) primitive["material"] = mesh.material;
    Json names = Json::array();
    for (const MorphTarget& target : mesh.morph_targets) {
      primitive["targets"].push_back(AddMorphTarget(mesh, target));
      names.push_back(character_.shapes[static_cast<std::size_t>(target.shape)]);
    }
    Json json = {{"name", mesh.name}, {"primitives", Json::array({std::move(primitive)})}};
    if (!names.empty()) json["extras"] = {{"targetNames", std::move(names)}};
    root_["meshes"].push_back(std::move(json));
  }

  // Positions and normals, and tangents if the target has any. Normals are written even if they are
  // zero, because readers compute missing ones.
  Json AddMorphTarget(const Mesh& mesh, const MorphTarget& target) {
    std::vector<std::uint32_t> vertices;
    std::vector<glm::vec3> positions, normals, tangents;
    // A sparse accessor's limits include the zeros that it does not state.
    const bool all = target.deltas.size() == mesh.vertices.size();
    glm::vec3 low = all ? target.deltas.front().position : glm::vec3(0.0f);
    glm::vec3 high = low;
    bool has_tangents = false;
    for (const MorphDelta& delta : target.deltas) {
      vertices.push_back(delta.vertex);
      positions.push_back(delta.position);
      low = glm::min(low, delta.position);
      high = glm::max(high, delta.position);
      normals.push_back(delta.normal);
      tangents.push_back(delta.tangent);
      has_tangents = has_tangents || delta.tangent != glm::vec3(0.0f);
    }
    const Builder::SparseIndices indices = builder_.AddSparseIndices(vertices);
    const auto add = [&](const std::vector<glm::vec3>& values) {
      return builder_.AddSparseAccessor(indices, values, "VEC3", mesh.vertices.size());
    };
    const int position = add(positions);
    builder_.accessor(position)["min"] = gltf::ToJson(low);
    builder_.accessor(position)["max"] = gltf::ToJson(high);
    Json json = {{"POSITION", position}, {"NORMAL", add(normals)}};
    if (has_tangents) json["TANGENT"] = add(tangents);
    return json;
  }

  // Joints and indices use the narrowest integers that hold all of them.
  int AddJoints(const std::vector<glm::u16vec4>& joints) {
    if (character_.skeleton.num_joints() > std::numeric_limits<std::uint8_t>::max() + 1) {
      return builder_.AddAccessor(joints, Builder::kUnsignedShort, "VEC4", Builder::kArrayBuffer);
    }
    const std::vector<glm::u8vec4> narrow(joints.begin(), joints.end());
    return builder_.AddAccessor(narrow, Builder::kUnsignedByte, "VEC4", Builder::kArrayBuffer);
  }

  int AddIndices(const Mesh& mesh) {
    // The highest number of each width is reserved: it restarts a strip.
    if (mesh.vertices.size() > std::numeric_limits<std::uint16_t>::max()) {
      return builder_.AddAccessor(mesh.indices, Builder::kUnsignedInt, "SCALAR",
                                  Builder::kElementBuffer);
    }
    const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
    return builder_.AddAccessor(narrow, Builder::kUnsignedShort, "SCALAR", Builder::kElementBuffer);
  }

  // Texture i refers to picture i.
  void AddMaterials() {
    for (const Material& m : character_.materials) {
      Json pbr = {
          {"baseColorFactor", {m.base_colour.r, m.base_colour.g, m.base_colour.b, m.base_colour.a}},
          {"metallicFactor", 0},
          {"roughnessFactor", m.roughness}};
      if (m.base_colour_texture >= 0) pbr["baseColorTexture"] = TextureOf(m, m.base_colour_texture);
      if (m.roughness_texture >= 0) {
        pbr["metallicRoughnessTexture"] = TextureOf(m, m.roughness_texture);
      }
      Json material = {{"name", m.name}, {"pbrMetallicRoughness", std::move(pbr)}};
      if (m.normal_texture >= 0) material["normalTexture"] = TextureOf(m, m.normal_texture);
      if (m.alpha_cutoff > 0.0f) {
        material["alphaMode"] = "MASK";
        material["alphaCutoff"] = m.alpha_cutoff;
      }
      if (m.double_sided) material["doubleSided"] = true;
      AddEmission(m, &material);
      if (m.thickness > 0.0f) AddThickness(m, &material);
      material["extras"] = {{gltf::kKindExtra, MaterialKindName(m.kind)}};
      if (!m.wrinkles) material["extras"][gltf::kWrinklesExtra] = false;
      if (IsAtlasTile(m)) material["extras"][gltf::kAtlasTileExtra] = true;
      root_["materials"].push_back(std::move(material));
    }
  }

  static bool IsAtlasTile(const Material& m) {
    return m.texture_scale != glm::vec2(1.0f) || m.texture_offset != glm::vec2(0.0f);
  }

  Json TextureOf(const Material& m, int picture) {
    Json texture = {{"index", picture}};
    if (IsAtlasTile(m)) {
      texture["extensions"]["KHR_texture_transform"] = {
          {"offset", {m.texture_offset.x, m.texture_offset.y}},
          {"scale", {m.texture_scale.x, m.texture_scale.y}}};
      UseExtension("KHR_texture_transform");
    }
    return texture;
  }

  void UseExtension(const std::string& name) {
    Json& used = root_["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
  }

  // glTF limits emissiveFactor to 1; an extension states the rest.
  void AddEmission(const Material& m, Json* material) {
    const float strength = std::max({m.emission.r, m.emission.g, m.emission.b, 1.0f});
    if (m.emission != glm::vec3(0.0f)) {
      (*material)["emissiveFactor"] = gltf::ToJson(m.emission / strength);
    }
    if (m.emission_texture >= 0) {
      (*material)["emissiveTexture"] = TextureOf(m, m.emission_texture);
    }
    if (strength > 1.0f) {
      (*material)["extensions"]["KHR_materials_emissive_strength"] = {
          {"emissiveStrength", strength}};
      UseExtension("KHR_materials_emissive_strength");
    }
  }

  void AddThickness(const Material& m, Json* material) {
    Json volume = {{"thicknessFactor", m.thickness}};
    if (m.thickness_texture >= 0) volume["thicknessTexture"] = TextureOf(m, m.thickness_texture);
    (*material)["extensions"]["KHR_materials_volume"] = std::move(volume);
    UseExtension("KHR_materials_volume");
  }

  Status AddPicture(const Picture& picture) {
    const Result<std::string> png = EncodePng(picture);
    FURROW_RETURN_IF_ERROR(png);
    const int view = builder_.AddView(png->data(), png->size(), Builder::kNoTarget);
    root_["textures"].push_back({{"source", root_["textures"].size()}});
    root_["images"].push_back(
        {{"name", picture.name}, {"mimeType", "image/png"}, {"bufferView", view}});
    return {};
  }

  const Character& character_;
  Builder builder_;
  Json& root_ = builder_.root();
};

}  // namespace

Result<std::string> CharacterGlb(const Character& character) {
  return CharacterWriter(character).Run();
}

}  // namespace furrow::character
