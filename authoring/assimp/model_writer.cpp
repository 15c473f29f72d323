// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/model_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "authoring/assimp/assimp_materials.h"
#include "authoring/assimp/gltf_pieces.h"
#include "authoring/assimp/scene_file.h"
#include "authoring/assimp/shape_groups.h"
#include "base/status.h"
#include "gltf/limits.h"
#include "gltf/scene/transform.h"
#include "gltf/write/builder.h"
#include "gltf/write/scene_json.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/skeleton/transform.h"

namespace furrow::authoring {
namespace {

// Converts a scene to glTF.
class SceneWriter {
 public:
  explicit SceneWriter(const aiScene& scene) : scene_(scene) {}

  Result<std::string> Run(std::vector<std::string>* remarks) {
    FURROW_RETURN_IF_ERROR(CollectNodes());
    FURROW_RETURN_IF_ERROR(FindJoints());
    AddMovingParts();
    WriteNodes();
    AddSkin();
    FURROW_RETURN_IF_ERROR(AddMeshes());
    AssimpMaterials(scene_, &builder_).Run(&remarks_);
    RemarkOnRest();
    root_["nodes"] = std::move(nodes_);
    root_["scenes"] =
        GltfJson::array({{{"name", NameFrom(scene_.mName)}, {"nodes", std::move(roots_)}}});
    *remarks = std::move(remarks_);
    return builder_.Finish();
  }

 private:
  struct SourceNode {
    const aiNode* node;
    int parent;       // index into sources_; -1 for the root
    glm::mat4 model;  // as in the file; for a kept node, as written
    bool is_joint = false;
    int written = -1;  // index into nodes_; -1 if not kept
  };

  // Collects all nodes, parents first.
  Status CollectNodes() {
    sources_.push_back({scene_.mRootNode, -1, wrinkle::ToMatrix(SpaceOf(scene_, &remarks_))});
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const aiNode& node = *sources_[i].node;
      sources_[i].model *= ToGlm(node.mTransformation);
      sources_by_name_[NameFrom(node.mName)].push_back(i);
      for (unsigned m = 0; m < node.mNumMeshes; ++m) instances_.emplace_back(node.mMeshes[m], i);
      for (unsigned c = 0; c < node.mNumChildren; ++c) {
        if (sources_.size() >= gltf::kMaxNodes) {
          return {StatusCode::kLimit,
                  "the file has more than " + std::to_string(gltf::kMaxNodes) + " nodes"};
        }
        sources_.push_back({node.mChildren[c], static_cast<int>(i), sources_[i].model});
      }
    }
    return {};
  }

  // Finds the joints of skins: every node that a bone names.
  Status FindJoints() {
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene_.mMeshes[m];
      for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const std::string name = NameFrom(mesh.mBones[b]->mName);
        if (!sources_by_name_.contains(name)) {
          return {StatusCode::kSchema, "mesh '" + NameFrom(mesh.mName) + "' names the joint '" +
                                           name + "', which is missing from the file"};
        }
        joint_by_name_.emplace(name, 0);
      }
    }
    for (auto& [name, source] : joint_by_name_) {
      source = JointNamed(name);
      sources_[source].is_joint = true;
    }
    return {};
  }

  // Nodes below joints that the file's animations move, and that lead to a rigid mesh, are joints,
  // too: eyeballs, teeth, props. Otherwise the mesh would follow the joint above.
  void AddMovingParts() {
    std::vector<bool> joints, rigid;
    for (const SourceNode& source : sources_) {
      joints.push_back(source.is_joint);
      rigid.push_back(HasRigidMesh(*source.node));
    }
    const std::vector<bool> below = BelowMarked(joints);
    const std::vector<bool> leads = WithThoseAbove(rigid);
    std::vector<bool> all = joints;
    for (const std::size_t i : MovingSources()) all[i] = joints[i] || (below[i] && leads[i]);
    if (all == joints) return;
    // The joints that bones name may fit.
    if (NumKept(all) > wrinkle::kMaxJoints) {
      remarks_.push_back(
          "some rigid parts do not move by themselves, because a skeleton has at most " +
          std::to_string(wrinkle::kMaxJoints) + " joints");
      return;
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) sources_[i].is_joint = all[i];
  }

  [[nodiscard]] bool HasRigidMesh(const aiNode& node) const {
    return std::any_of(node.mMeshes, node.mMeshes + node.mNumMeshes,
                       [this](unsigned mesh) { return scene_.mMeshes[mesh]->mNumBones == 0; });
  }

  // The nodes that an animation moves out of their rest. Exporters of FBX bake a channel for every
  // node, whether it moves or not.
  [[nodiscard]] std::vector<std::size_t> MovingSources() const {
    std::vector<std::size_t> moving;
    for (unsigned a = 0; a < scene_.mNumAnimations; ++a) {
      const aiAnimation& animation = *scene_.mAnimations[a];
      for (unsigned c = 0; c < animation.mNumChannels; ++c) {
        const aiNodeAnim& channel = *animation.mChannels[c];
        const auto found = sources_by_name_.find(NameFrom(channel.mNodeName));
        // Animations tell nodes apart by their names alone.
        if (found == sources_by_name_.end() || found->second.size() != 1) continue;
        const std::size_t source = found->second[0];
        if (LeavesRest(channel, ToGlm(sources_[source].node->mTransformation))) {
          moving.push_back(source);
        }
      }
    }
    return moving;
  }

  // True if a key differs from the node's own transform by more than exporters round.
  static bool LeavesRest(const aiNodeAnim& channel, const glm::mat4& local) {
    constexpr float kSmall = 1e-4f;
    const gltf::Transform rest = InvertibleTransform(local);
    const auto differs = [](const glm::vec3& rest_value) {
      return [rest_value](const aiVectorKey& key) {
        const float size = std::max(1.0f, glm::length(rest_value));
        return !(glm::distance(ToGlm(key.mValue), rest_value) <= kSmall * size);
      };
    };
    const auto turns = [&rest](const aiQuatKey& key) {
      const aiQuaternion& q = key.mValue;
      // The cosine of half of the angle between the two: 0.16 degrees.
      return !(std::abs(glm::dot(glm::quat(q.w, q.x, q.y, q.z), rest.rotation)) >= 1.0f - 1e-6f);
    };
    return std::any_of(channel.mPositionKeys, channel.mPositionKeys + channel.mNumPositionKeys,
                       differs(rest.translation)) ||
           std::any_of(channel.mRotationKeys, channel.mRotationKeys + channel.mNumRotationKeys,
                       turns) ||
           std::any_of(channel.mScalingKeys, channel.mScalingKeys + channel.mNumScalingKeys,
                       differs(rest.scale));
  }

  // Per node: true if a node above it is marked.
  [[nodiscard]] std::vector<bool> BelowMarked(const std::vector<bool>& marked) const {
    std::vector<bool> below(sources_.size(), false);
    for (std::size_t i = 1; i < sources_.size(); ++i) {  // parents come first
      const auto parent = static_cast<std::size_t>(sources_[i].parent);
      below[i] = below[parent] || marked[parent];
    }
    return below;
  }

  // Marks the nodes above marked ones, too.
  [[nodiscard]] std::vector<bool> WithThoseAbove(std::vector<bool> marked) const {
    for (std::size_t i = sources_.size(); i-- > 1;) {
      if (marked[i]) marked[static_cast<std::size_t>(sources_[i].parent)] = true;
    }
    return marked;
  }

  // How many nodes WriteNodes() would keep, which the reader takes for joints.
  [[nodiscard]] int NumKept(const std::vector<bool>& joints) const {
    const std::vector<bool> below = BelowMarked(joints);
    const std::vector<bool> leads = WithThoseAbove(joints);
    int kept = 0;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      kept += joints[i] || (below[i] && leads[i]) ? 1 : 0;
    }
    return kept;
  }

  // The node that a bone means. FBX files may give a mesh the name of a bone.
  [[nodiscard]] std::size_t JointNamed(const std::string& name) const {
    const std::vector<std::size_t>& sources = sources_by_name_.at(name);
    return *std::ranges::max_element(sources, {},
                                     [this](std::size_t source) { return JointLikeness(source); });
  }

  // Joints have no meshes, and joints above or below them.
  [[nodiscard]] int JointLikeness(std::size_t source) const {
    const aiNode& node = *sources_[source].node;
    const auto is_named = [this](const aiNode* other) {
      return other != nullptr && joint_by_name_.contains(NameFrom(other->mName));
    };
    const bool has_joints =
        is_named(node.mParent) ||
        std::any_of(node.mChildren, node.mChildren + node.mNumChildren, is_named);
    return (node.mNumMeshes == 0 ? 2 : 0) + (has_joints ? 1 : 0);
  }

  // Writes the joints and the nodes between them. Nodes above all joints (scene, armature, axes,
  // unit) are folded into the topmost joints.
  void WriteNodes() {
    std::vector<bool> below(sources_.size(), false);
    for (std::size_t i = sources_.size(); i-- > 1;) {
      if (below[i] || sources_[i].is_joint)
        below[static_cast<std::size_t>(sources_[i].parent)] = true;
    }
    std::unordered_set<std::string> names;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      SourceNode& source = sources_[i];
      const int parent = Kept(source.parent);
      if (!source.is_joint && (parent < 0 || !below[i])) continue;
      const glm::mat4 above = parent < 0 ? glm::mat4(1.0f) : sources_[parent].model;
      const gltf::Transform local = InvertibleTransform(glm::inverse(above) * source.model);
      source.model = above * gltf::ToMatrix(local);
      source.written = static_cast<int>(nodes_.size());
      std::string name = NameFrom(source.node->mName);
      if (!names.insert(name).second) name += "." + std::to_string(i);
      (parent < 0 ? roots_ : nodes_[sources_[parent].written]["children"]).push_back(nodes_.size());
      nodes_.push_back(gltf::NodeJson(name, local));
      if (source.is_joint) {
        joint_of_source_[i] = joints_.size();
        joints_.push_back(i);
      }
    }
  }

  // The nearest kept node at or above a node, or -1.
  [[nodiscard]] int Kept(int source) const {
    while (source >= 0 && sources_[source].written < 0) source = sources_[source].parent;
    return source;
  }

  void AddSkin() {
    if (joints_.empty()) return;
    std::vector<glm::mat4> inverse_bind;
    GltfJson joints = GltfJson::array();
    for (const std::size_t source : joints_) {
      inverse_bind.push_back(glm::inverse(sources_[source].model));
      joints.push_back(sources_[source].written);
    }
    root_["skins"] = GltfJson::array(
        {{{"inverseBindMatrices", builder_.AddAccessor(inverse_bind, gltf::Builder::kFloat, "MAT4",
                                                       gltf::Builder::kNoTarget)},
          {"joints", std::move(joints)}}});
  }

  // Counts before converting: one mesh may be instanced many times.
  Status AddMeshes() {
    std::size_t vertices = 0;
    std::size_t indices = 0;
    for (const auto& [mesh, source] : instances_) {
      vertices += scene_.mMeshes[mesh]->mNumVertices;
      indices += std::size_t{3} * scene_.mMeshes[mesh]->mNumFaces;
      if (vertices > gltf::kMaxVertices || indices > gltf::kMaxIndices) {
        return {StatusCode::kLimit, "the meshes have more than " +
                                        std::to_string(gltf::kMaxVertices) + " vertices or " +
                                        std::to_string(gltf::kMaxIndices / 3) + " triangles"};
      }
      AddMesh(*scene_.mMeshes[mesh], source);
    }
    if (root_.contains("meshes")) return {};
    return {StatusCode::kUnsupported,
            "the file has no mesh",
            {},
            "export the character with its mesh and skeleton"};
  }

  // Influences by vertex, the strongest first.
  std::vector<std::vector<Influence>> InfluencesOf(const aiMesh& mesh) {
    std::vector<std::vector<Influence>> influences(mesh.mNumVertices);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const std::size_t joint = JointOf(bone);
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        // Files may name missing vertices. NaN counts as no weight.
        if (weight.mVertexId >= mesh.mNumVertices || !(weight.mWeight > 0.0f)) continue;
        influences[weight.mVertexId].push_back({joint, weight.mWeight});
      }
    }
    for (auto& list : influences) {
      std::stable_sort(list.begin(), list.end(),
                       [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
      if (list.size() > std::size_t{4} * gltf::kMaxInfluenceSets)
        list.resize(std::size_t{4} * gltf::kMaxInfluenceSets);
    }
    return influences;
  }

  [[nodiscard]] std::size_t JointOf(const aiBone& bone) const {
    return joint_of_source_.at(joint_by_name_.at(NameFrom(bone.mName)));
  }

  // The matrix from mesh space to model space in the rest pose, for each joint of the mesh.
  std::unordered_map<std::size_t, glm::mat4> SkinMatrices(const aiMesh& mesh) {
    std::unordered_map<std::size_t, glm::mat4> matrices;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const std::size_t joint = JointOf(bone);
      matrices[joint] = sources_[joints_[joint]].model * ToGlm(bone.mOffsetMatrix);
    }
    return matrices;
  }

  // The placement of each vertex of a mesh. Skinned meshes: model space in the rest pose. Other
  // meshes: the space of the nearest kept node.
  std::vector<glm::mat4> Placements(const aiMesh& mesh, std::size_t source,
                                    const std::vector<std::vector<Influence>>& influences) {
    const int kept = Kept(static_cast<int>(source));
    if (mesh.mNumBones == 0) {
      const glm::mat4 above = kept < 0 ? glm::mat4(1.0f) : sources_[kept].model;
      return std::vector<glm::mat4>(mesh.mNumVertices,
                                    glm::inverse(above) * sources_[source].model);
    }
    const std::unordered_map<std::size_t, glm::mat4> matrices = SkinMatrices(mesh);
    std::vector<glm::mat4> placements(mesh.mNumVertices, sources_[source].model);
    for (std::size_t v = 0; v < placements.size(); ++v) {
      if (influences[v].empty()) continue;
      glm::mat4 blend(0.0f);
      float sum = 0.0f;
      for (const Influence& influence : influences[v]) {
        blend += matrices.at(influence.joint) * influence.weight;
        sum += influence.weight;
      }
      placements[v] = blend / sum;
    }
    return placements;
  }

  void AddMesh(const aiMesh& mesh, std::size_t source) {
    const bool skinned = mesh.mNumBones > 0;
    const std::vector<std::uint32_t> indices = TrianglesOf(mesh);
    if (indices.empty() || mesh.mNumVertices == 0) return;
    const std::vector<std::vector<Influence>> influences = InfluencesOf(mesh);
    const std::vector<glm::mat4> placements = Placements(mesh, source, influences);
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      positions.emplace_back(placements[v] * glm::vec4(ToGlm(mesh.mVertices[v]), 1.0f));
      if (mesh.HasNormals()) {
        normals.push_back(glm::mat3(placements[v]) * ToGlm(mesh.mNormals[v]));
      }
      if (mesh.HasTextureCoords(0)) {
        uvs.emplace_back(mesh.mTextureCoords[0][v].x, 1.0f - mesh.mTextureCoords[0][v].y);
      }
    }
    using B = gltf::Builder;
    GltfJson attributes;
    attributes["POSITION"] = builder_.AddAccessor(positions, B::kFloat, "VEC3", B::kArrayBuffer);
    if (!normals.empty()) {
      attributes["NORMAL"] = builder_.AddAccessor(normals, B::kFloat, "VEC3", B::kArrayBuffer);
    }
    if (!uvs.empty()) {
      attributes["TEXCOORD_0"] = builder_.AddAccessor(uvs, B::kFloat, "VEC2", B::kArrayBuffer);
    }
    if (skinned) AddInfluences(influences, &builder_, &attributes);
    GltfJson primitive = {
        {"attributes", std::move(attributes)},
        {"indices", builder_.AddAccessor(indices, B::kUnsignedInt, "SCALAR", B::kElementBuffer)},
        {"material", mesh.mMaterialIndex}};
    std::string name = NameFrom(mesh.mName);
    if (name.empty()) name = "mesh_" + std::to_string(root_["meshes"].size());
    GltfJson holder = {{"name", "mesh:" + name}, {"mesh", root_["meshes"].size()}};
    if (skinned) holder["skin"] = 0;
    // glTF ignores the transform of a skinned mesh's node, so the node goes to the root.
    const int kept = skinned ? -1 : Kept(static_cast<int>(source));
    (kept < 0 ? roots_ : nodes_[sources_[kept].written]["children"]).push_back(nodes_.size());
    nodes_.push_back(std::move(holder));
    GltfJson target_names = AddMorphTargets(mesh, placements, &primitive);
    GltfJson written = {{"name", std::move(name)},
                        {"primitives", GltfJson::array({std::move(primitive)})}};
    if (!target_names.empty()) written["extras"] = {{"targetNames", std::move(target_names)}};
    root_["meshes"].push_back(std::move(written));
  }

  // Adds the shapes that move a vertex to `primitive` and returns their names. Shapes state
  // positions; the reader computes the change of the normals.
  GltfJson AddMorphTargets(const aiMesh& mesh, const std::vector<glm::mat4>& placements,
                           GltfJson* primitive) {
    GltfJson names = GltfJson::array();
    for (const ShapeGroup& group : GroupShapes(mesh)) {
      for (const NamedDeltas& target : TargetsOf(group, mesh, &remarks_)) {
        if (AddMorphTarget(target.deltas, placements, primitive)) names.push_back(target.name);
      }
    }
    return names;
  }

  // Returns false for a shape that moves nothing or exceeds the limit.
  bool AddMorphTarget(const std::vector<glm::vec3>& all, const std::vector<glm::mat4>& placements,
                      GltfJson* primitive) {
    std::vector<std::uint32_t> vertices;
    std::vector<glm::vec3> deltas;
    for (std::uint32_t v = 0; v < all.size(); ++v) {
      if (all[v] == glm::vec3(0.0f)) continue;
      vertices.push_back(v);
      deltas.push_back(glm::mat3(placements[v]) * all[v]);
    }
    if (vertices.empty() || vertices.size() > morph_deltas_) {
      left_out_ += vertices.empty() ? 0 : 1;
      return false;
    }
    morph_deltas_ -= vertices.size();
    (*primitive)["targets"].push_back(
        {{"POSITION", builder_.AddSparseAccessor(builder_.AddSparseIndices(vertices), deltas,
                                                 "VEC3", all.size())}});
    return true;
  }

  // assimp has triangulated. Faces with fewer corners are points and lines.
  static std::vector<std::uint32_t> TrianglesOf(const aiMesh& mesh) {
    std::vector<std::uint32_t> indices;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices == 3) indices.insert(indices.end(), face.mIndices, face.mIndices + 3);
    }
    return indices;
  }

  void RemarkOnRest() {
    if (left_out_ > 0) {
      remarks_.push_back(std::to_string(left_out_) +
                         " blend shapes are not imported: the shapes move too many vertices");
    }
  }

  const aiScene& scene_;
  gltf::Builder builder_;
  GltfJson& root_ = builder_.root();
  GltfJson nodes_ = GltfJson::array();
  GltfJson roots_ = GltfJson::array();
  std::vector<SourceNode> sources_;
  std::unordered_map<std::string, std::vector<std::size_t>> sources_by_name_;  // parents first
  std::unordered_map<std::string, std::size_t> joint_by_name_;  // the nodes that bones name
  std::vector<std::pair<unsigned, std::size_t>> instances_;     // mesh, source
  std::vector<std::size_t> joints_;                             // sources, in the skin's order
  std::unordered_map<std::size_t, std::size_t> joint_of_source_;
  std::size_t morph_deltas_ = gltf::kMaxMorphDeltas;  // that may still be written
  unsigned left_out_ = 0;                             // blend shapes beyond that
  std::vector<std::string> remarks_;
};

}  // namespace

Result<std::string> WriteModel(const aiScene& scene, std::vector<std::string>* remarks) {
  Result<std::string> glb = SceneWriter(scene).Run(remarks);
  if (glb.ok() && scene.mNumAnimations > 0) {
    remarks->emplace_back(
        "the file's animations are not imported; 'furrow play' plays the file itself");
  }
  return glb;
}

}  // namespace furrow::authoring
