// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/character_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "base/status.h"
#include "character/mesh/move_mesh.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;
using wrinkle::kNoJoint;

glm::vec3 RestPlace(const wrinkle::Skeleton& skeleton, int joint) {
  return glm::vec3(skeleton.rest_model()[static_cast<std::size_t>(joint)][3]);
}

// The direction from the subject's right to its left, summed over all available pairs; zero if
// none.
glm::vec3 Across(const wrinkle::Skeleton& skeleton, const FoundJoints& joints) {
  glm::vec3 sum(0.0f);
  for (const JointRole left : {JointRole::kLeftUpperLeg, JointRole::kLeftUpperArm,
                               JointRole::kLeftShoulder, JointRole::kLeftEye}) {
    const int l = joints.First(left);
    const int r = joints.First(wrinkle::MirrorOf(left));
    if (l != kNoJoint && r != kNoJoint) sum += RestPlace(skeleton, l) - RestPlace(skeleton, r);
  }
  return sum;
}

// Away from the ends of the limbs, or else from the lowest to the highest known joint of the trunk;
// zero if fewer than two are known.
glm::vec3 Up(const wrinkle::Skeleton& skeleton, const FoundJoints& joints) {
  if (const auto up = wrinkle::UpFromLimbs(skeleton, joints.roles)) return *up;
  constexpr std::array kTrunk = {JointRole::kHips,       JointRole::kSpine, JointRole::kChest,
                                 JointRole::kUpperChest, JointRole::kNeck,  JointRole::kHead};
  int lowest = kNoJoint;
  int highest = kNoJoint;
  for (const JointRole role : kTrunk) {
    const int joint = joints.First(role);
    if (joint == kNoJoint) continue;
    if (lowest == kNoJoint) lowest = joint;
    highest = joint;
  }
  return lowest == highest ? glm::vec3(0.0f)
                           : RestPlace(skeleton, highest) - RestPlace(skeleton, lowest);
}

// The axis of the largest component other than `except` (-1: none excepted).
int LargestComponent(const glm::vec3& v, int except) {
  int largest = except == 0 ? 1 : 0;
  for (int i = 0; i < 3; ++i) {
    if (i != except && std::abs(v[i]) > std::abs(v[largest])) largest = i;
  }
  return largest;
}

std::string AxisName(const glm::vec3& v) {
  const int axis = LargestComponent(v, -1);
  return std::string(1, v[axis] < 0.0f ? '-' : '+') + "XYZ"[axis];
}

ModelKind FindModelKind(const wrinkle::Skeleton& skeleton, const FoundJoints& joints) {
  constexpr int kFewJoints = 8;  // a body has more
  const auto has = [&](std::initializer_list<JointRole> roles) {
    return std::ranges::any_of(roles,
                               [&](JointRole role) { return joints.First(role) != kNoJoint; });
  };
  if (has({JointRole::kLeftUpperLeg, JointRole::kRightUpperLeg})) return ModelKind::kBody;
  if (has({JointRole::kHips, JointRole::kLeftUpperArm, JointRole::kRightUpperArm,
           JointRole::kLeftHand, JointRole::kRightHand})) {
    return ModelKind::kUnknown;
  }
  const bool is_head = has({JointRole::kNeck, JointRole::kHead, JointRole::kJaw,
                            JointRole::kLeftEye, JointRole::kRightEye});
  return is_head || skeleton.num_joints() < kFewJoints ? ModelKind::kHead : ModelKind::kUnknown;
}

// The unit that brings `height` nearest to that of a person. 1 if the height is plausible already.
float UsualScale(float height, ModelKind kind) {
  constexpr float kOfHead = 0.3f;
  constexpr float kOfBody = 1.7f;
  const float least = (kind == ModelKind::kBody ? kOfBody : kOfHead) / 3.5f;
  const float most = (kind == ModelKind::kHead ? kOfHead : kOfBody) * 3.0f;
  if (height > least && height < most) return 1.0f;
  const float usual = kind == ModelKind::kBody   ? kOfBody
                      : kind == ModelKind::kHead ? kOfHead
                                                 : std::sqrt(kOfHead * kOfBody);
  constexpr std::array kUnits = {0.001f, 0.01f, 0.1f, 10.0f, 100.0f, 0.0254f, 0.3048f};
  // If head and body are both possible, inches and feet fit too many heights.
  const auto end = kind == ModelKind::kUnknown ? kUnits.end() - 2 : kUnits.end();
  return *std::min_element(kUnits.begin(), end, [&](float a, float b) {
    return std::abs(std::log(height * a / usual)) < std::abs(std::log(height * b / usual));
  });
}

// The matrix that moves a vertex to the rest pose.
glm::mat4 RestMatrix(const character::Vertex& vertex, std::span<const glm::mat4> skin_matrices) {
  glm::mat4 blend(0.0f);
  for (int i = 0; i < 4; ++i) {
    if (vertex.skin_weights[i] > 0.0f) {
      blend += skin_matrices[vertex.joints[i]] * vertex.skin_weights[i];
    }
  }
  return blend;
}

// Where the file's own bind pose differs from its rest pose, these are not the identity.
std::vector<glm::mat4> RestSkinMatrices(const character::Character& character) {
  std::vector<glm::mat4> matrices;
  for (std::size_t j = 0; j < character.inverse_bind_matrices.size(); ++j) {
    matrices.push_back(character.skeleton.rest_model()[j] * character.inverse_bind_matrices[j]);
  }
  return matrices;
}

// The same joints at rotated and scaled positions in model space, without scales of their own.
Result<wrinkle::Skeleton> Rebuild(const wrinkle::Skeleton& from, const glm::mat3& turn,
                                  float scale) {
  const auto moved = [&](const glm::vec3& p) { return turn * p * scale; };
  const glm::quat rotation = glm::quat_cast(turn);
  std::vector<wrinkle::JointDesc> joints;
  for (int j = 0; j < from.num_joints(); ++j) {
    const int parent = from.joint_parents()[j];
    const glm::mat4& model = from.rest_model()[static_cast<std::size_t>(j)];
    const glm::quat axes = rotation * from.rest_model_rotations()[static_cast<std::size_t>(j)];
    wrinkle::JointDesc joint{from.joint_names()[j], parent, from.rest_pose()[j], {}};
    joint.rest.scale = glm::vec3(1.0f);
    const glm::vec3 position = moved(glm::vec3(model[3]));
    if (parent < 0) {
      joint.rest.translation = position;
      joint.rest.rotation = axes;
    } else {
      const glm::quat above =
          rotation * from.rest_model_rotations()[static_cast<std::size_t>(parent)];
      joint.rest.translation = glm::inverse(above) * (position - moved(RestPlace(from, parent)));
    }
    const glm::vec3 tail = glm::vec3(model * glm::vec4(from.tails()[j], 1.0f));
    joint.tail = glm::inverse(axes) * (moved(tail) - position);
    joints.push_back(std::move(joint));
  }
  return wrinkle::Skeleton::Create(std::move(joints));
}

// False for NaN.
bool IsNearIdentity(const glm::mat4& m) {
  const glm::mat4 identity(1.0f);
  for (int i = 0; i < 16; ++i) {
    if (!(std::abs(glm::value_ptr(m)[i] - glm::value_ptr(identity)[i]) < 1e-5f)) return false;
  }
  return true;
}

// The vertices are in the rest pose now, so the inverse bind matrices follow from the skeleton.
Status ReplaceSkeleton(const glm::mat3& turn, float scale, character::Character* character) {
  Result<wrinkle::Skeleton> skeleton = Rebuild(character->skeleton, turn, scale);
  FURROW_RETURN_IF_ERROR(skeleton);
  character->skeleton = std::move(*skeleton);
  character->inverse_bind_matrices.clear();
  for (const glm::mat4& rest : character->skeleton.rest_model()) {
    character->inverse_bind_matrices.push_back(glm::inverse(rest));
  }
  return {};
}

}  // namespace

CharacterSpace FindCharacterSpace(const character::Character& character,
                                  const FoundJoints& joints) {
  CharacterSpace space;
  space.kind = FindModelKind(character.skeleton, joints);
  glm::vec3 up(0.0f, 1.0f, 0.0f);
  const glm::vec3 trunk = Up(character.skeleton, joints);
  const glm::vec3 across = Across(character.skeleton, joints);
  if (glm::length(trunk) > 0.0f && glm::length(across) > 0.0f) {
    glm::vec3 left(0.0f);
    up = glm::vec3(0.0f);
    // Files differ by whole axes. Snapping to axes ignores the slight lean of a posed trunk.
    const int up_axis = LargestComponent(trunk, -1);
    const int left_axis = LargestComponent(across, up_axis);
    up[up_axis] = trunk[up_axis] < 0.0f ? -1.0f : 1.0f;
    left[left_axis] = across[left_axis] < 0.0f ? -1.0f : 1.0f;
    const glm::vec3 forward = glm::cross(left, up);
    space.rotation = glm::transpose(glm::mat3(left, up, forward));
    space.axes = "up " + AxisName(up) + ", facing " + AxisName(forward);
  }
  const std::vector<glm::mat4> skin = RestSkinMatrices(character);
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
  for (const character::Mesh& mesh : character.meshes) {
    for (const character::Vertex& vertex : mesh.vertices) {
      const glm::vec4 position(vertex.position, 1.0f);
      const float along = glm::dot(glm::vec3(RestMatrix(vertex, skin) * position), up);
      low = std::min(low, along);
      high = std::max(high, along);
    }
  }
  space.height = std::max(high - low, 0.0f);
  if (space.height > 0.0f) space.scale = UsualScale(space.height, space.kind);
  return space;
}

Status MoveToSpace(const glm::mat3& rotation, float scale, character::Character* character) {
  const glm::mat4 move(rotation * scale);
  for (character::Mesh& mesh : character->meshes) {
    character::MoveMesh([&](const character::Vertex&) { return move; }, &mesh);
  }
  return ReplaceSkeleton(rotation, scale, character);
}

Status BringToRestPose(character::Character* character) {
  const std::vector<glm::mat4> skin = RestSkinMatrices(*character);
  const bool at_rest = std::all_of(skin.begin(), skin.end(), IsNearIdentity);
  const auto rest = character->skeleton.rest_pose();
  const bool scaled = std::any_of(rest.begin(), rest.end(), [](const wrinkle::Transform& t) {
    return glm::length(t.scale - glm::vec3(1.0f)) > 1e-5f;
  });
  if (at_rest && !scaled) return {};
  for (character::Mesh& mesh : character->meshes) {
    character::MoveMesh([&](const character::Vertex& v) { return RestMatrix(v, skin); }, &mesh);
  }
  return ReplaceSkeleton(glm::mat3(1.0f), 1.0f, character);
}

}  // namespace furrow::authoring
