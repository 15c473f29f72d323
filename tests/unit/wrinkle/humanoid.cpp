// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/humanoid.h"

#include <algorithm>

namespace furrow::wrinkle {
namespace {

struct Entry {
  const char* role;
  const char* parent;
  glm::vec3 origin;
};

const Entry kMiddle[] = {
    {"hips", "", {0, 0.95f, 0}},           {"spine", "hips", {0, 1.05f, 0}},
    {"chest", "spine", {0, 1.2f, -0.01f}}, {"upperChest", "chest", {0, 1.33f, -0.01f}},
    {"neck", "upperChest", {0, 1.47f, 0}}, {"head", "neck", {0, 1.57f, 0.02f}},
};
// Of the left side.
const Entry kSide[] = {
    {"Shoulder", "upperChest", {0.03f, 1.42f, 0}},
    {"UpperArm", "Shoulder", {0.17f, 1.42f, 0}},
    {"LowerArm", "UpperArm", {0.45f, 1.42f, 0}},
    {"Hand", "LowerArm", {0.7f, 1.42f, 0}},
    {"ThumbMetacarpal", "Hand", {0.73f, 1.41f, 0.03f}},
    {"ThumbProximal", "ThumbMetacarpal", {0.76f, 1.41f, 0.05f}},
    {"ThumbDistal", "ThumbProximal", {0.785f, 1.41f, 0.06f}},
    {"IndexProximal", "Hand", {0.79f, 1.42f, 0.025f}},
    {"IndexIntermediate", "IndexProximal", {0.825f, 1.42f, 0.025f}},
    {"MiddleProximal", "Hand", {0.79f, 1.42f, 0.003f}},
    {"MiddleIntermediate", "MiddleProximal", {0.83f, 1.42f, 0.003f}},
    {"LittleProximal", "Hand", {0.778f, 1.42f, -0.038f}},
    {"LittleIntermediate", "LittleProximal", {0.806f, 1.42f, -0.038f}},
    {"UpperLeg", "hips", {0.09f, 0.9f, 0}},
    {"LowerLeg", "UpperLeg", {0.09f, 0.48f, 0.01f}},
    {"Foot", "LowerLeg", {0.09f, 0.07f, -0.02f}},
    {"Toes", "Foot", {0.1f, 0.02f, 0.11f}},
};

std::string Sided(const char* side, const char* name) {
  const bool middle = name[0] >= 'a' && name[0] <= 'z';
  return middle ? std::string(name) : std::string(side) + name;
}

}  // namespace

Humanoid MakeHumanoid() {
  Humanoid body;
  const auto add = [&](const std::string& name, const std::string& parent, const glm::vec3& at) {
    body.joints.push_back({ParseJointRole(name).value(), {name, parent, at, {}}});
  };
  for (const Entry& entry : kMiddle) add(entry.role, entry.parent, entry.origin);
  for (const char* side : {"left", "right"}) {
    const glm::vec3 mirror(side[0] == 'l' ? 1.0f : -1.0f, 1.0f, 1.0f);
    for (const Entry& entry : kSide) {
      add(Sided(side, entry.role), Sided(side, entry.parent), entry.origin * mirror);
    }
  }
  return body;
}

bool Humanoid::IsBelow(const ModelJoint& joint, const std::string& above) const {
  if (joint.name == above) return true;
  const auto parent = std::ranges::find_if(
      joints, [&](const Joint& other) { return other.place.name == joint.parent; });
  return parent != joints.end() && IsBelow(parent->place, above);
}

void Humanoid::Turn(const std::string& joint, float degrees, const glm::vec3& axis) {
  const glm::quat rotation = AngleAxis(degrees, axis);
  glm::vec3 centre(0.0f);
  for (const Joint& each : joints) {
    if (each.place.name == joint) centre = each.place.origin;
  }
  for (Joint& each : joints) {
    if (!IsBelow(each.place, joint)) continue;
    each.place.origin = centre + rotation * (each.place.origin - centre);
  }
}

void Humanoid::Remove(const std::string& joint) {
  const auto gone =
      std::ranges::find_if(joints, [&](const Joint& each) { return each.place.name == joint; });
  for (Joint& each : joints) {
    if (each.place.parent == joint) each.place.parent = gone->place.parent;
  }
  joints.erase(gone);
}

void Humanoid::Split(const std::string& joint, const std::string& end, float share) {
  const auto find = [&](const std::string& name) {
    return std::ranges::find_if(joints, [&](const Joint& each) { return each.place.name == name; });
  };
  const auto upper = find(joint);
  const auto lower = find(end);
  Joint added = *upper;
  added.place.name = joint + "2";
  added.place.parent = joint;
  added.place.origin = glm::mix(upper->place.origin, lower->place.origin, share);
  lower->place.parent = added.place.name;
  joints.insert(upper + 1, added);
}

void Humanoid::Transform(const glm::quat& rotation, float scale, const glm::vec3& shift) {
  for (Joint& each : joints) each.place.origin = rotation * each.place.origin * scale + shift;
}

void Humanoid::Prefix(const std::string& prefix) {
  for (Joint& each : joints) {
    each.place.name = prefix + each.place.name;
    if (!each.place.parent.empty()) each.place.parent = prefix + each.place.parent;
  }
}

JointRoles Humanoid::Roles() const {
  JointRoles roles;
  for (const Joint& each : joints) roles.push_back(each.role);
  return roles;
}

std::vector<ModelJoint> Humanoid::Places() const {
  std::vector<ModelJoint> places;
  for (const Joint& each : joints) places.push_back(each.place);
  return places;
}

}  // namespace furrow::wrinkle
