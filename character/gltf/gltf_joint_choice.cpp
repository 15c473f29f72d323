// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_joint_choice.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <unordered_set>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "base/text.h"
#include "gltf/scene/meshes.h"
#include "gltf/scene/skins.h"
#include "gltf/scene/vrm_humanoid.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {
namespace {

using HumanBones = std::vector<std::pair<std::string, int>>;
using IsEyeName = std::function<bool(const std::string&)>;

class JointChooser {
 public:
  JointChooser(gltf::Document* document, const gltf::NodeForest& forest, const IsEyeName& is_eye)
      : document_(*document), forest_(forest), is_eye_(is_eye), nodes_(forest) {}

  Result<GltfJointChoice> Run() {
    // The roles that Furrow has written win.
    const auto has_role = [](const gltf::Node& node) { return !node.role.empty(); };
    if (std::ranges::none_of(forest_.nodes, has_role)) bones_ = gltf::ReadVrmHumanoid(&document_);
    GltfJointChoice choice;
    const std::size_t num_skins = gltf::NumSkins(document_);
    if (num_skins == 0) nodes_.AddAll();
    for (std::size_t skin = 0; skin < num_skins; ++skin) {
      Result<std::vector<int>> joints = gltf::ReadSkinJoints(document_, skin);
      FURROW_RETURN_IF_ERROR(joints);
      for (const int node : *joints) nodes_.AddWithAncestors(node);
      choice.of_skins.push_back(std::move(*joints));
    }
    AddRigidParts();
    choice.list = gltf::ListJoints(forest_, nodes_, {}, &document_);
    TakeRolesOfVrm(&choice.list);
    return choice;
  }

 private:
  void AddRigidParts() {
    is_part_ = gltf::FindRigidParts(forest_, nodes_);
    std::vector<int> more;
    const auto add = [&](int node) {
      const bool exists = node < static_cast<int>(forest_.nodes.size());
      if (exists && is_part_[static_cast<std::size_t>(node)]) more.push_back(node);
    };
    for (const int node : document_.moving_nodes()) add(node);
    for (const auto& [name, node] : bones_) add(node);
    for (const int node : forest_.order) {
      if (!forest_.nodes[static_cast<std::size_t>(node)].role.empty()) add(node);
    }
    if (bones_.empty() && is_eye_) FindEyes(&more);
    if (more.empty()) return;
    gltf::NodeSet all = nodes_;
    for (const int node : more) all.AddWithAncestors(node);
    const auto size = std::ranges::count_if(forest_.order, [&](int node) { return all.Has(node); });
    // The joints of the skins alone may fit.
    if (size > wrinkle::kMaxJoints) {
      document_.Warn("nodes",
                     "some rigid parts do not move by themselves, because a skeleton has "
                     "at most " +
                         std::to_string(wrinkle::kMaxJoints) + " joints");
      return;
    }
    for (const int node : more) nodes_.AddWithAncestors(node);
  }

  // Tries each name once, because a second joint of a name gets another name and so no role.
  void FindEyes(std::vector<int>* eyes) {
    std::unordered_set<std::string> tried;
    for (const int node : forest_.order) {
      if (nodes_.Has(node)) tried.insert(forest_.nodes[static_cast<std::size_t>(node)].name);
    }
    const std::size_t most = tried.size() + std::size_t{wrinkle::kMaxJoints};
    for (const int node : forest_.order) {
      const std::string& name = forest_.nodes[static_cast<std::size_t>(node)].name;
      if (!is_part_[static_cast<std::size_t>(node)] || !tried.insert(name).second) continue;
      if (is_eye_(name) && HoldsItsOrigin(node)) eyes->push_back(node);
      if (tried.size() >= most) return;
    }
  }

  [[nodiscard]] bool HoldsItsOrigin(int node) const {
    const std::optional<gltf::Bounds> bounds = gltf::BoundsOfPart(document_, forest_, node);
    return bounds && glm::all(glm::lessThanEqual(bounds->low, glm::vec3(0.0f))) &&
           glm::all(glm::greaterThanEqual(bounds->high, glm::vec3(0.0f)));
  }

  // VRM may add names that are not roles.
  void TakeRolesOfVrm(gltf::JointList* list) {
    for (auto& [name, node] : bones_) {
      const int joint = list->joint_of_node[static_cast<std::size_t>(node)];
      if (joint == gltf::kNone || !wrinkle::ParseJointRole(name)) continue;
      list->joints[static_cast<std::size_t>(joint)].role = std::move(name);
    }
  }

  gltf::Document& document_;
  const gltf::NodeForest& forest_;
  const IsEyeName& is_eye_;
  gltf::NodeSet nodes_;
  std::vector<bool> is_part_;  // per node
  HumanBones bones_;
};

}  // namespace

Result<GltfJointChoice> ChooseGltfJoints(gltf::Document* document, const gltf::NodeForest& forest,
                                         const IsEyeName& is_eye_name) {
  if (forest.nodes.empty()) return Status(StatusCode::kSchema, "the file has no nodes", "nodes");
  return JointChooser(document, forest, is_eye_name).Run();
}

}  // namespace furrow::character
