// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/blend_shapes/blend_shape_face.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "authoring/generator/blend_shapes/face_shapes.h"
#include "authoring/skinning/influences.h"

namespace furrow::authoring {
namespace {

using wrinkle::kNoJoint;

// The joints without the face, and where the skin weights of each old joint go.
struct JointCut {
  std::vector<wrinkle::JointDesc> joints;
  std::vector<int> kept;       // per new joint: the old joint
  std::vector<int> new_joint;  // per old joint: itself, or its nearest ancestor that stays
};

bool IsOfFace(const wrinkle::Skeleton& skeleton, int head, int joint) {
  const std::string& name = skeleton.joint_names()[static_cast<std::size_t>(joint)];
  return (joint != head && skeleton.IsAncestor(head, joint)) || name.starts_with("platysma_");
}

// Leaves get their old tails, because the tails of fingers and feet were stated, and the head's was
// the middle of its face.
JointCut CutFace(const wrinkle::Skeleton& skeleton, int head) {
  JointCut cut;
  std::set<int> parents;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const int parent = skeleton.joint_parents()[index];
    const int above =
        parent == kNoJoint ? kNoJoint : cut.new_joint[static_cast<std::size_t>(parent)];
    if (IsOfFace(skeleton, head, j)) {
      cut.new_joint.push_back(above);
      continue;
    }
    cut.new_joint.push_back(static_cast<int>(cut.joints.size()));
    cut.kept.push_back(j);
    parents.insert(above);
    cut.joints.push_back({.name = skeleton.joint_names()[index],
                          .parent = above,
                          .rest = skeleton.rest_pose()[index],
                          .tail = {}});
  }
  for (std::size_t j = 0; j < cut.joints.size(); ++j) {
    if (parents.contains(static_cast<int>(j))) continue;
    cut.joints[j].tail = skeleton.tails()[static_cast<std::size_t>(cut.kept[j])];
  }
  return cut;
}

void MoveWeights(const JointCut& cut, character::Mesh* mesh) {
  for (character::Vertex& vertex : mesh->vertices) {
    InfluenceSum sum;
    for (int k = 0; k < 4; ++k) {
      const int joint = cut.new_joint[vertex.joints[k]];
      sum.Add(static_cast<std::uint16_t>(joint), vertex.skin_weights[k]);
    }
    sum.Strongest().CopyTo(&vertex);
  }
}

Status RemoveFaceJoints(character::Character* character) {
  const int head = character->skeleton.Find("head");
  if (head == kNoJoint) {
    return {StatusCode::kNotFound, "the skeleton has no joint 'head'", character->name};
  }
  JointCut cut = CutFace(character->skeleton, head);
  auto skeleton = wrinkle::Skeleton::Create(std::move(cut.joints));
  FURROW_RETURN_IF_ERROR(skeleton);
  std::vector<glm::mat4> inverse_bind;
  for (const int old : cut.kept) {
    inverse_bind.push_back(character->inverse_bind_matrices[static_cast<std::size_t>(old)]);
  }
  character->inverse_bind_matrices = std::move(inverse_bind);
  character->skeleton = std::move(skeleton).value();
  for (character::Mesh& mesh : character->meshes) MoveWeights(cut, &mesh);
  return {};
}

}  // namespace

wrinkle::Rig BlendShapeRig(const wrinkle::Rig& from) {
  using Kind = wrinkle::Driver::Kind;
  wrinkle::Rig rig = from;
  rig.name = from.name + "-blend-shapes";
  rig.reference_poses.clear();
  std::erase_if(rig.drivers, [](const wrinkle::Driver& driver) {
    return driver.kind == Kind::kPose || driver.kind == Kind::kStrain;
  });
  std::set<std::string> drivers, regions;
  for (const wrinkle::Driver& driver : rig.drivers) drivers.insert(driver.name);
  for (wrinkle::Region& region : rig.regions) {
    for (wrinkle::Feed& feed : region.feeds) {
      std::erase_if(feed.sources, [&](const auto& s) { return !drivers.contains(s.driver); });
    }
    std::erase_if(region.feeds, [](const wrinkle::Feed& feed) { return feed.sources.empty(); });
    if (!region.feeds.empty()) regions.insert(region.name);
  }
  std::erase_if(rig.regions, [](const wrinkle::Region& region) { return region.feeds.empty(); });
  for (wrinkle::Region& region : rig.regions) {
    std::erase_if(region.neighbours, [&](const auto& name) { return !regions.contains(name); });
  }
  return rig;
}

Status MakeBlendShapeFace(character::Character* character) {
  FURROW_RETURN_IF_ERROR(AddFaceShapes(character));
  FURROW_RETURN_IF_ERROR(RemoveFaceJoints(character));
  character->rig = BlendShapeRig(character->rig);
  return {};
}

}  // namespace furrow::authoring
