// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_match.h"

#include <algorithm>
#include <set>
#include <span>

#include "base/status.h"
#include "wrinkle/rig/rig_joints.h"

namespace furrow::rig {
namespace {

using wrinkle::JointRole;

std::string_view NameOf(JointRole role) { return wrinkle::ToString(role); }

// By name, because the fingers of the two sides are apart in the enumeration.
bool IsFinger(JointRole role) {
  const std::string_view name = NameOf(role);
  return std::ranges::any_of(
      std::initializer_list<std::string_view>{"Thumb", "Index", "Middle", "Ring", "Little"},
      [name](std::string_view finger) { return name.find(finger) != std::string_view::npos; });
}

bool IsOfFace(JointRole role) {
  return role == JointRole::kJaw || role == JointRole::kLeftEye || role == JointRole::kRightEye;
}

// The joint that a role stands for in a rig: the first joint of the role's chain.
const std::string* FirstOf(JointRole role, const wrinkle::JointRoles& roles,
                           std::span<const std::string> names) {
  const auto found = std::ranges::find(roles, role);
  return found == roles.end() ? nullptr : &names[static_cast<std::size_t>(found - roles.begin())];
}

}  // namespace

Result<SkeletonMatcher> SkeletonMatcher::Create(const std::string& name_or_file) {
  auto shipped = SkeletonMaps::LoadShipped();
  FURROW_RETURN_IF_ERROR(shipped);
  SkeletonMatcher matcher;
  matcher.characters_ = *shipped;
  matcher.streams_ = *std::move(shipped);
  if (name_or_file.empty()) return matcher;
  auto chosen = SkeletonMaps::Load(name_or_file);
  FURROW_RETURN_IF_ERROR(chosen);
  // A chosen map may also describe the user's own character, so it joins the maps for characters.
  // For streams it replaces them.
  const auto known = matcher.characters_.maps();
  std::vector<SkeletonMap> all(known.begin(), known.end());
  all.push_back(chosen->maps().front());
  matcher.characters_ = SkeletonMaps(std::move(all));
  matcher.streams_ = *std::move(chosen);
  return matcher;
}

SkeletonMatch SkeletonMatcher::Match(const wrinkle::Skeleton& stream, const wrinkle::Rig& rig,
                                     const wrinkle::Skeleton* character) const {
  SkeletonMatch match;
  match.stream = streams_.RolesOf(stream);
  if (character != nullptr) match.character = characters_.RolesOf(*character);
  if (match.stream.roles.empty()) return match;

  // The roles of a rig's joints follow from their names alone, since a rig has no skeleton.
  const std::set<std::string> joints = wrinkle::JointsOf(rig);
  const std::vector<std::string> names(joints.begin(), joints.end());
  const SkeletonRoles own = characters_.RolesOf(names);
  for (std::size_t i = 0; i < own.roles.size(); ++i) {
    // Equal names need no alias.
    if (stream.Find(names[i]) != wrinkle::kNoJoint) continue;
    const JointRole role = own.roles[i];
    if (role == JointRole::kNone) continue;
    const std::string* theirs = FirstOf(role, match.stream.roles, stream.joint_names());
    if (theirs != nullptr) match.aliases.emplace_back(names[i], *theirs);
  }
  return match;
}

wrinkle::Retarget MakeRetarget(const SkeletonMatch& match, const wrinkle::Skeleton& stream,
                               const wrinkle::Skeleton& character) {
  return wrinkle::Retarget::Create(stream, match.stream.roles, character, match.character.roles,
                                   match.stream.toes_height);
}

std::string Describe(const SkeletonRoles& roles) {
  if (roles.map.empty()) return {};
  std::string text =
      "skeleton map '" + roles.map + "': " + std::to_string(roles.num_roles) + " roles";
  // Body captures without fingers or a face are usual; listing all of these roles would bury the
  // rest.
  std::vector<JointRole> missing = roles.missing;
  for (const auto& kind : {IsFinger, IsOfFace}) {
    if (std::ranges::none_of(roles.roles, kind)) std::erase_if(missing, kind);
  }
  if (!missing.empty()) text += "; missing: " + JoinRoles(missing);
  return text;
}

}  // namespace furrow::rig
