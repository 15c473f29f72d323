// SPDX-License-Identifier: Apache-2.0
#include "character/intake/face_frame.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

namespace furrow::character {
namespace {

using wrinkle::JointRole;
using wrinkle::kNoJoint;
using wrinkle::Skeleton;

constexpr float kFar = 1.0f / 3.0f;  // of the distance between the eyes

struct FaceFrame {
  glm::vec3 middle;
  float unit;  // distance between the eyes
};

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

// The two places that a joint may stand for, in the frame of its face.
struct Places {
  glm::vec3 origin;
  glm::vec3 tail;
};

Places PlacesOf(const Skeleton& skeleton, const FaceFrame& frame, int joint) {
  const auto index = static_cast<std::size_t>(joint);
  const glm::mat4& model = skeleton.rest_model()[index];
  const auto parents = skeleton.joint_parents();
  const bool leaf = std::find(parents.begin(), parents.end(), joint) == parents.end();
  const glm::vec3 origin(model[3]);
  const glm::vec3 tail(model * glm::vec4(skeleton.tails()[index], 1.0f));
  return {(origin - frame.middle) / frame.unit,
          ((leaf ? tail : origin) - frame.middle) / frame.unit};
}

float Distance(const Places& a, const Places& b) {
  return std::min({glm::distance(a.origin, b.origin), glm::distance(a.origin, b.tail),
                   glm::distance(a.tail, b.origin), glm::distance(a.tail, b.tail)});
}

int Nearest(const Places& place, const std::vector<Places>& among) {
  int nearest = kNoJoint;
  float least = kFar;
  for (std::size_t i = 0; i < among.size(); ++i) {
    const float distance = Distance(place, among[i]);
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

}  // namespace

int FaceMatch::Of(int model_joint) const {
  return model_joint < 0 || model_joint >= static_cast<int>(joint.size())
             ? kNoJoint
             : joint[static_cast<std::size_t>(model_joint)];
}

std::vector<int> FaceJoints(const Skeleton& skeleton, const FoundJoints& joints) {
  std::vector<int> face;
  const int head = joints.Last(JointRole::kHead);
  for (int j = 0; head != kNoJoint && j < skeleton.num_joints(); ++j) {
    const bool has_role = joints.roles[static_cast<std::size_t>(j)] != JointRole::kNone;
    if (j != head && !has_role && skeleton.IsAncestor(head, j)) face.push_back(j);
  }
  return face;
}

FaceMatch MatchFaces(const Skeleton& model, const FoundJoints& model_joints, const Skeleton& target,
                     const FoundJoints& target_joints) {
  FaceMatch match;
  match.joint.assign(static_cast<std::size_t>(model.num_joints()), kNoJoint);
  const std::optional<FaceFrame> model_frame = FrameOf(model, model_joints);
  const std::optional<FaceFrame> target_frame = FrameOf(target, target_joints);
  if (!model_frame || !target_frame) return match;
  for (const JointRole role : {JointRole::kHead, JointRole::kJaw, JointRole::kLeftEye,
                               JointRole::kRightEye, JointRole::kNeck}) {
    const int from = model_joints.First(role);
    if (from != kNoJoint) match.joint[static_cast<std::size_t>(from)] = target_joints.First(role);
  }
  const std::vector<int> model_face = FaceJoints(model, model_joints);
  const std::vector<int> target_face = FaceJoints(target, target_joints);
  std::vector<Places> model_places, target_places;
  for (const int j : model_face) model_places.push_back(PlacesOf(model, *model_frame, j));
  for (const int j : target_face) target_places.push_back(PlacesOf(target, *target_frame, j));
  for (std::size_t i = 0; i < model_face.size(); ++i) {
    int& to = match.joint[static_cast<std::size_t>(model_face[i])];
    const int same = target.Find(model.joint_names()[static_cast<std::size_t>(model_face[i])]);
    if (same != kNoJoint) {
      to = same;
      continue;
    }
    const int nearest = Nearest(model_places[i], target_places);
    if (nearest == kNoJoint) continue;
    const int back = Nearest(target_places[static_cast<std::size_t>(nearest)], model_places);
    if (back == static_cast<int>(i)) to = target_face[static_cast<std::size_t>(nearest)];
  }
  return match;
}

}  // namespace furrow::character
