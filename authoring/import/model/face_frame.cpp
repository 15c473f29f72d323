// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/face_frame.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include <glm/geometric.hpp>

#include "authoring/bake/surface/bake_surface.h"
#include "base/ascii.h"

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;
using wrinkle::kNoJoint;
using wrinkle::Skeleton;

constexpr float kFar = 0.4f;  // maximum distance of a match, in distances between the eyes

struct FaceFrame {
  glm::vec3 middle;
  float unit;  // distance between the eyes
};

// The eyes give the face an origin and a unit, so that faces of different size and place can be
// compared. Nothing without two separate eyes.
std::optional<FaceFrame> FrameOf(const Skeleton& skeleton, const FoundJoints& joints) {
  const int l = joints.First(JointRole::kLeftEye);
  const int r = joints.First(JointRole::kRightEye);
  if (l == kNoJoint || r == kNoJoint) return std::nullopt;
  const glm::vec3 left(skeleton.rest_model()[static_cast<std::size_t>(l)][3]);
  const glm::vec3 right(skeleton.rest_model()[static_cast<std::size_t>(r)][3]);
  const float unit = glm::length(left - right);
  if (!(unit > 0.0f)) return std::nullopt;
  return FaceFrame{0.5f * (left + right), unit};
}

// A position that may match a joint, in the frame of its face.
struct Place {
  glm::vec3 at;
  int joint;
  bool is_tail;
};

// The joint's origin, and for a leaf also its tail, where a virtual muscle ends.
void AddPlaces(const Skeleton& skeleton, const FaceFrame& frame, int joint,
               std::vector<Place>* places) {
  const auto index = static_cast<std::size_t>(joint);
  const glm::mat4& model = skeleton.rest_model()[index];
  places->push_back({(glm::vec3(model[3]) - frame.middle) / frame.unit, joint, false});
  const auto parents = skeleton.joint_parents();
  if (std::find(parents.begin(), parents.end(), joint) != parents.end()) return;
  const glm::vec3 tail(model * glm::vec4(skeleton.tails()[index], 1.0f));
  places->push_back({(tail - frame.middle) / frame.unit, joint, true});
}

// The nearest place within kFar; null if there is none.
const Place* Nearest(const glm::vec3& at, const std::vector<Place>& among) {
  const Place* nearest = nullptr;
  float least = kFar;
  for (const Place& place : among) {
    const float distance = glm::distance(at, place.at);
    if (distance >= least) continue;
    least = distance;
    nearest = &place;
  }
  return nearest;
}

}  // namespace

int FaceMatch::Of(int model_joint) const {
  return model_joint < 0 || model_joint >= static_cast<int>(joint.size())
             ? kNoJoint
             : joint[static_cast<std::size_t>(model_joint)];
}

bool IsAdornment(std::string_view name) {
  constexpr const char* kWords[] = {"hair", "bang",  "ponytail", "braid", "strand", "ribbon",
                                    "hat",  "glass", "earring",  "skirt", "hood",   "accessor",
                                    "horn", "cloth", "helmet",   "veil"};
  const std::string lower = AsciiLower(std::string(name));
  return std::any_of(std::begin(kWords), std::end(kWords),
                     [&](const char* word) { return lower.find(word) != std::string::npos; });
}

std::vector<int> FaceJoints(const Skeleton& skeleton, const FoundJoints& joints) {
  std::vector<int> face;
  const int head = joints.Last(JointRole::kHead);
  std::vector<bool> worn(static_cast<std::size_t>(skeleton.num_joints()), false);
  for (int j = 0; head != kNoJoint && j < skeleton.num_joints(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    if (j == head || !skeleton.IsAncestor(head, j)) continue;
    // Parents come first, so a whole chain of hair follows its first joint.
    const int parent = skeleton.joint_parents()[index];
    worn[index] =
        worn[static_cast<std::size_t>(parent)] || IsAdornment(skeleton.joint_names()[index]);
    const bool has_role = joints.roles[index] != JointRole::kNone;
    if (!has_role && !worn[index]) face.push_back(j);
  }
  return face;
}

FaceMatch MatchFaces(const Skeleton& model, const FoundJoints& model_joints,
                     std::span<const glm::vec3> model_points, const Skeleton& target,
                     const FoundJoints& target_joints) {
  FaceMatch match;
  match.joint.assign(static_cast<std::size_t>(model.num_joints()), kNoJoint);
  match.by_tail.assign(match.joint.size(), false);
  const std::optional<FaceFrame> model_frame = FrameOf(model, model_joints);
  const std::optional<FaceFrame> target_frame = FrameOf(target, target_joints);
  if (!model_frame || !target_frame) return match;
  for (const JointRole role : {JointRole::kHead, JointRole::kJaw, JointRole::kLeftEye,
                               JointRole::kRightEye, JointRole::kNeck}) {
    const int from = model_joints.First(role);
    if (from != kNoJoint) match.joint[static_cast<std::size_t>(from)] = target_joints.First(role);
  }
  std::vector<Place> model_places, target_places;
  for (const int j : FaceJoints(model, model_joints)) {
    const glm::vec3& point = model_points[static_cast<std::size_t>(j)];
    model_places.push_back({(point - model_frame->middle) / model_frame->unit, j, false});
  }
  for (const int j : FaceJoints(target, target_joints)) {
    AddPlaces(target, *target_frame, j, &target_places);
  }
  for (const Place& place : model_places) {
    const auto from = static_cast<std::size_t>(place.joint);
    match.joint[from] = target.Find(model.joint_names()[from]);
    if (match.joint[from] != kNoJoint) continue;
    const Place* nearest = Nearest(place.at, target_places);
    // A match must be mutual. Otherwise a sparse face would map many muscles to one joint.
    const Place* back = nearest == nullptr ? nullptr : Nearest(nearest->at, model_places);
    if (back != &place) continue;
    match.joint[from] = nearest->joint;
    match.by_tail[from] = nearest->is_tail;
  }
  return match;
}

int HeadMaterial(const character::Character& character, const FoundJoints& joints) {
  const int head = joints.First(wrinkle::JointRole::kHead);
  if (head == wrinkle::kNoJoint) return -1;
  const auto parents = character.skeleton.joint_parents();
  std::vector<bool> above_neck(parents.size(), false);  // parents come first
  for (std::size_t j = static_cast<std::size_t>(head); j < parents.size(); ++j) {
    above_neck[j] = static_cast<int>(j) == head ||
                    (parents[j] >= 0 && above_neck[static_cast<std::size_t>(parents[j])]);
  }
  std::vector<float> areas(character.materials.size(), 0.0f);
  for (const int index : MeshesOn(character, false)) {
    const character::Mesh& mesh = character.meshes[static_cast<std::size_t>(index)];
    if (mesh.material < 0) continue;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const character::Vertex& a = mesh.vertices[mesh.indices[i]];
      float share = 0.0f;
      for (int k = 0; k < 4; ++k) share += above_neck[a.joints[k]] ? a.skin_weights[k] : 0.0f;
      areas[static_cast<std::size_t>(mesh.material)] +=
          share * glm::length(glm::cross(mesh.vertices[mesh.indices[i + 1]].position - a.position,
                                         mesh.vertices[mesh.indices[i + 2]].position - a.position));
    }
  }
  const auto largest = std::max_element(areas.begin(), areas.end());
  if (largest == areas.end() || !(*largest > 0.0f)) return -1;
  return static_cast<int>(largest - areas.begin());
}

}  // namespace furrow::authoring
