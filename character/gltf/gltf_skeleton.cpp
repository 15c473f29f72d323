// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_skeleton.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "base/text.h"
#include "character/gltf/gltf_joint_choice.h"
#include "gltf/scene/joints.h"
#include "gltf/scene/skins.h"

namespace furrow::character {
namespace {

using wrinkle::kNoJoint;

bool IsFinite(const glm::mat4& m) {
  const float* values = glm::value_ptr(m);
  return std::all_of(values, values + 16, [](float v) { return std::isfinite(v); });
}

// Exporters round the same matrix differently, so the comparison has a tolerance.
bool AreNear(const glm::mat4& a, const glm::mat4& b) {
  for (int k = 0; k < 16; ++k) {
    const float x = glm::value_ptr(a)[k];
    if (std::abs(x - glm::value_ptr(b)[k]) > 1e-3f * (1.0f + std::abs(x))) return false;
  }
  return true;
}

// The role that a node states.
Result<wrinkle::JointRole> RoleOf(const gltf::Joint& joint) {
  if (joint.role.empty()) return wrinkle::JointRole::kNone;
  const std::optional<wrinkle::JointRole> role = wrinkle::ParseJointRole(joint.role);
  if (role) return *role;
  return Status(StatusCode::kSchema, "unknown role " + Quoted(joint.role),
                "nodes[" + std::to_string(joint.node) + "].extras." + gltf::kRoleExtra,
                "roles have the names of VRM's bones: hips, leftUpperArm, ...");
}

class SkeletonReader {
 public:
  SkeletonReader(gltf::Document* document, const gltf::NodeForest& forest,
                 const ReadOptions& options)
      : document_(*document), forest_(forest), options_(options) {}

  Result<GltfSkeleton> Run() {
    Result<GltfJointChoice> chosen = ChooseGltfJoints(&document_, forest_, options_.is_eye_name);
    FURROW_RETURN_IF_ERROR(chosen);
    result_.skin_joints = std::move(chosen->of_skins);  // MapNodes() turns nodes into joints
    FURROW_RETURN_IF_ERROR(BuildSkeleton(chosen->list));
    MapNodes();
    FURROW_RETURN_IF_ERROR(ReadInverseBindMatrices());
    MoveNodesToBindPose();
    return std::move(result_);
  }

 private:
  Status BuildSkeleton(const gltf::JointList& list) {
    result_.num_nameless_joints = list.num_nameless;
    std::vector<wrinkle::JointDesc> joints;
    for (const gltf::Joint& joint : list.joints) {
      joints.push_back({joint.name,
                        joint.parent,
                        {joint.rest.translation, joint.rest.rotation, joint.rest.scale},
                        joint.tail});
    }
    Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
    if (!skeleton.ok()) return skeleton.status().At("nodes");
    result_.skeleton = std::move(*skeleton);
    joint_at_.assign(forest_.nodes.size(), kNoJoint);
    for (int j = 0; j < result_.skeleton.num_joints(); ++j) {
      const auto source =
          static_cast<std::size_t>(result_.skeleton.source_index()[static_cast<std::size_t>(j)]);
      joint_at_[static_cast<std::size_t>(list.joints[source].node)] = j;
    }
    return ReadRoles(list);
  }

  // Leaves the list empty if the file states no role.
  Status ReadRoles(const gltf::JointList& list) {
    wrinkle::JointRoles roles;
    bool has_any = false;
    for (const std::int16_t source : result_.skeleton.source_index()) {
      const auto role = RoleOf(list.joints[static_cast<std::size_t>(source)]);
      FURROW_RETURN_IF_ERROR(role);
      roles.push_back(*role);
      has_any = has_any || *role != wrinkle::JointRole::kNone;
    }
    if (has_any) result_.roles = std::move(roles);
    return {};
  }

  // Meshes on nodes that are not joints follow the nearest joint above; without one, they follow
  // the first joint.
  void MapNodes() {
    std::vector<int> nearest = joint_at_;
    for (const int node : forest_.order) {
      const int parent = forest_.nodes[static_cast<std::size_t>(node)].parent;
      int& joint = nearest[static_cast<std::size_t>(node)];
      if (joint == kNoJoint && parent != gltf::kNone) {
        joint = nearest[static_cast<std::size_t>(parent)];
      }
    }
    for (int& joint : nearest) joint = std::max(joint, 0);
    result_.joint_of_node = std::move(nearest);
    result_.node_model = gltf::ModelMatrices(forest_);
    for (std::vector<int>& joints : result_.skin_joints) {
      for (int& joint : joints) joint = joint_at_[static_cast<std::size_t>(joint)];
    }
  }

  Status ReadInverseBindMatrices() {
    for (const glm::mat4& rest : result_.skeleton.rest_model()) {
      const glm::mat4 inverse = glm::inverse(rest);
      // A flat rest pose has no inverse.
      const bool usable = IsFinite(inverse);
      result_.inverse_bind_matrices.push_back(usable ? inverse : glm::mat4(1.0f));
      binds_.push_back(usable ? rest : glm::mat4(1.0f));
    }
    for (std::size_t skin = 0; skin < result_.skin_joints.size(); ++skin) {
      Result<std::vector<glm::mat4>> matrices = gltf::ReadInverseBindMatrices(document_, skin);
      FURROW_RETURN_IF_ERROR(matrices);
      stated_.push_back(std::move(*matrices));
    }
    result_.skin_moves.resize(stated_.size());
    if (HasConflict() || HidesTransform()) {
      MoveSkinsToRest();
    } else {
      KeepStatedMatrices();
    }
    return {};
  }

  // True if two skins bind one joint differently. Quantised exports do, because each mesh has a
  // scale of its own, and so do meshes that were bound in different poses.
  [[nodiscard]] bool HasConflict() const {
    std::vector<const glm::mat4*> first(binds_.size(), nullptr);
    for (std::size_t skin = 0; skin < stated_.size(); ++skin) {
      for (std::size_t i = 0; i < stated_[skin].size(); ++i) {
        const glm::mat4*& known = first[JointOf(skin, i)];
        if (known != nullptr && !AreNear(*known, stated_[skin][i])) return true;
        if (known == nullptr) known = &stated_[skin][i];
      }
    }
    return false;
  }

  // True if a skin's matrices move or scale the whole mesh: KHR_mesh_quantization keeps there what
  // makes metres of its integers.
  [[nodiscard]] bool HidesTransform() const {
    for (std::size_t skin = 0; skin < stated_.size(); ++skin) {
      bool equal = true;
      bool scaled = false;
      const glm::mat4 first = Move(skin, 0);
      for (std::size_t i = 0; i < stated_[skin].size(); ++i) {
        const glm::mat4 move = Move(skin, i);
        equal = equal && AreNear(first, move);
        const float scale = std::cbrt(std::abs(glm::determinant(glm::mat3(move))));
        scaled = scaled || !(std::abs(scale - 1.0f) < 0.05f);
      }
      if (scaled || (equal && !AreNear(glm::mat4(1.0f), first))) return true;
    }
    return false;
  }

  // From the space of a skin's mesh to model space in the rest pose, by one of its joints.
  [[nodiscard]] glm::mat4 Move(std::size_t skin, std::size_t i) const {
    return binds_[JointOf(skin, i)] * stated_[skin][i];
  }

  [[nodiscard]] std::size_t JointOf(std::size_t skin, std::size_t i) const {
    return static_cast<std::size_t>(result_.skin_joints[skin][i]);
  }

  // Every joint gets the inverse of its rest pose, and meshes move there.
  void MoveSkinsToRest() {
    for (std::size_t skin = 0; skin < stated_.size(); ++skin) {
      std::vector<glm::mat4> moves;
      for (std::size_t i = 0; i < stated_[skin].size(); ++i) moves.push_back(Move(skin, i));
      const bool moved = std::any_of(moves.begin(), moves.end(), [](const glm::mat4& move) {
        return !AreNear(glm::mat4(1.0f), move);
      });
      if (moved) result_.skin_moves[skin] = std::move(moves);
    }
  }

  void KeepStatedMatrices() {
    std::vector<bool> is_stated(binds_.size(), false);
    for (std::size_t skin = 0; skin < stated_.size(); ++skin) {
      for (std::size_t i = 0; i < stated_[skin].size(); ++i) {
        const std::size_t joint = JointOf(skin, i);
        if (!is_stated[joint]) result_.inverse_bind_matrices[joint] = stated_[skin][i];
        is_stated[joint] = true;
      }
    }
  }

  // Rigid meshes rest where their nodes do. If the joint that they follow is bound in another pose,
  // they must be stated in that pose, like the vertices of skins.
  void MoveNodesToBindPose() {
    for (std::size_t node = 0; node < forest_.nodes.size(); ++node) {
      if (forest_.nodes[node].mesh == gltf::kNone) continue;
      const auto joint = static_cast<std::size_t>(result_.joint_of_node[node]);
      const glm::mat4 to_rest =
          result_.skeleton.rest_model()[joint] * result_.inverse_bind_matrices[joint];
      if (AreNear(glm::mat4(1.0f), to_rest)) continue;  // keeps the bits of the file
      const glm::mat4 to_bind = glm::inverse(to_rest);
      if (IsFinite(to_bind)) result_.node_model[node] = to_bind * result_.node_model[node];
    }
  }

  gltf::Document& document_;
  const gltf::NodeForest& forest_;
  const ReadOptions& options_;
  std::vector<int> joint_at_;     // per node: its own joint, or kNoJoint
  std::vector<glm::mat4> binds_;  // per joint: the inverse of the matrix made from its rest pose
  std::vector<std::vector<glm::mat4>> stated_;  // per skin and joint: the file's matrices
  GltfSkeleton result_;
};

}  // namespace

Result<GltfSkeleton> ReadGltfSkeleton(gltf::Document* document, const gltf::NodeForest& forest,
                                      const ReadOptions& options) {
  return SkeletonReader(document, forest, options).Run();
}

Result<NamedRoles> ReadGltfRoles(gltf::Document* document, const gltf::NodeForest& forest) {
  Result<GltfJointChoice> chosen = ChooseGltfJoints(document, forest, {});
  FURROW_RETURN_IF_ERROR(chosen);
  NamedRoles roles;
  for (gltf::Joint& joint : chosen->list.joints) {
    const auto role = RoleOf(joint);
    FURROW_RETURN_IF_ERROR(role);
    roles.emplace_back(std::move(joint.name), *role);
  }
  return roles;
}

}  // namespace furrow::character
