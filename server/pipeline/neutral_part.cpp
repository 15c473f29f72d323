// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/neutral_part.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace furrow::server {
namespace {

using wrinkle::JointRole;

constexpr std::array<std::pair<NeutralPart, std::string_view>, 3> kNames = {
    {{NeutralPart::kFace, "face"}, {NeutralPart::kBody, "body"}, {NeutralPart::kBoth, "both"}}};

}  // namespace

std::vector<bool> FaceJoints(const StreamDefinition& stream) {
  const wrinkle::Skeleton& skeleton = stream.skeleton;
  const wrinkle::JointRoles& roles = stream.match.stream.roles;
  const auto count = static_cast<std::size_t>(skeleton.num_joints());
  std::vector<bool> below(count, false);
  if (roles.size() != count) return below;
  for (std::size_t j = 0; j < count; ++j) {
    const int parent = skeleton.joint_parents()[j];
    const bool parent_is_head =
        parent >= 0 && roles[static_cast<std::size_t>(parent)] == JointRole::kHead;
    const bool parent_is_face = parent >= 0 && below[static_cast<std::size_t>(parent)];
    below[j] = wrinkle::IsOfFace(roles[j]) ||
               ((parent_is_head || parent_is_face) && roles[j] != JointRole::kHead);
  }
  return below;
}

std::optional<NeutralPart> ParseNeutralPart(std::string_view text) {
  for (const auto& [part, name] : kNames) {
    if (name == text) return part;
  }
  return std::nullopt;
}

std::string_view ToString(NeutralPart part) {
  return kNames[static_cast<std::size_t>(part)].second;
}

NeutralPart DefaultNeutralPart(const StreamDefinition& stream) {
  const std::vector<bool> face = FaceJoints(stream);
  const bool has_face =
      !stream.blend_shapes.empty() || std::find(face.begin(), face.end(), true) != face.end();
  return has_face ? NeutralPart::kFace : NeutralPart::kBoth;
}

wrinkle::LocalPose CaptureNeutralPart(NeutralPart part, const StreamDefinition& stream,
                                      const wrinkle::LocalPose& now,
                                      const std::optional<wrinkle::LocalPose>& former) {
  if (part == NeutralPart::kBoth) return now;
  wrinkle::LocalPose neutral;
  if (former) {
    neutral = *former;
  } else {
    neutral.SetRest(stream.skeleton);
    neutral.blend_shapes.assign(now.blend_shapes.size(), 0.0f);
  }
  const bool wants_face = part == NeutralPart::kFace;
  const std::vector<bool> face = FaceJoints(stream);
  for (std::size_t j = 0; j < face.size(); ++j) {
    if (face[j] == wants_face) neutral.joints[j] = now.joints[j];
  }
  if (wants_face) neutral.blend_shapes = now.blend_shapes;
  return neutral;
}

}  // namespace furrow::server
