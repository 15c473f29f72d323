// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/skeleton_fit.h"
#include "rig/skeleton_map.h"
#include "wrinkle/drivers/common/bind_options.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::rig {

// How the joints of a stream or recording correspond to a rig and to a character.
struct SkeletonMatch {
  SkeletonRoles stream;
  SkeletonFit fit;          // of the stream's roles
  SkeletonRoles character;  // empty without a character
  // Joints of the stream that have the name of a joint of the rig or of the character. Names match
  // without any map.
  int num_equal_names = 0;
  // The most roles that any map finds, if none of them fits.
  int most_roles = 0;
  // For BindOptions::aliases: (the rig's joint, the stream's joint of the same role).
  std::vector<std::pair<std::string, std::string>> aliases;
  // For BindOptions::role_chains: all joints of the stream that do the part of the rig's joint. A
  // spine of five joints does the part of one with two. Only for joints that twist drivers read.
  std::vector<wrinkle::RoleChain> role_chains;

  // How the stream's skeleton stands at rest; nullopt if its roles do not tell.
  std::optional<wrinkle::RestStance> stance;
  // There is no stance, but the rig reads joints of the stream: its axes are taken to be Furrow's.
  bool assumes_axes = false;

  // True if a joint of the rig is matched with this joint of the stream by its role.
  [[nodiscard]] bool Reads(std::string_view stream_joint) const;
  // RestStance::turn, or none.
  [[nodiscard]] glm::quat turn() const {
    return stance ? stance->turn : wrinkle::RestStance().turn;
  }
  // The options that bind the rig to the stream; they refer to this object.
  [[nodiscard]] wrinkle::BindOptions Options(bool allow_missing) const {
    return {.allow_missing = allow_missing,
            .aliases = aliases,
            .role_chains = role_chains,
            .turn = turn()};
  }
};

// Finds the roles of a stream's joints with the shipped maps and, if requested, one more.
class SkeletonMatcher {
 public:
  SkeletonMatcher() = default;  // no maps: joints match by equal names only

  // `name_or_file` is the map for every stream (SkeletonMaps::Load()); empty selects the best
  // shipped map per stream. A character's map is chosen among the shipped maps and that one.
  [[nodiscard]] static Result<SkeletonMatcher> Create(const std::string& name_or_file);

  // The roles that a character's package states for its joints (Character::roles), by name. They
  // hold, instead of any map, for the character, for the joints of a rig that have these names, and
  // for streams that have all joints with a role, such as the character's own animations, unless
  // the user chose a map for streams. So packages need no map when they are played. Joints with
  // kNone have no role.
  void SetCharacterRoles(std::span<const std::pair<std::string, wrinkle::JointRole>> roles);
  // The same for `roles`, one per joint of `character`; empty: the package states none.
  void SetCharacterRoles(const wrinkle::Skeleton& character, const wrinkle::JointRoles& roles);

  // The roles of a recording's joints, as Match() finds them.
  [[nodiscard]] SkeletonRoles RolesOf(const wrinkle::Skeleton& stream) const;
  // How a skeleton stands at rest, by its `roles`, as RolesOf() finds them. If they do not tell,
  // those of any map may, which then needs neither limbs nor many roles.
  [[nodiscard]] std::optional<wrinkle::RestStance> StanceOf(const wrinkle::Skeleton& skeleton,
                                                            const wrinkle::JointRoles& roles) const;

  // `character` may be null. It does not affect the aliases, so weights are the same with and
  // without pictures. The map that explains the most joint names of the rig gives their roles.
  // Joints that have the same name in the stream and in the rig get no alias. They get no chain
  // either, unless their roles differ: CMU's Spine is Mixamo's Spine1.
  [[nodiscard]] SkeletonMatch Match(const wrinkle::Skeleton& stream, const wrinkle::Rig& rig,
                                    const wrinkle::Skeleton* character) const;

 private:
  [[nodiscard]] SkeletonRoles RolesOfCharacter(const wrinkle::Skeleton& character) const;
  [[nodiscard]] wrinkle::JointRoles RolesOfRig(std::span<const std::string> joint_names) const;

  SkeletonMaps streams_;
  SkeletonMaps characters_;
  std::map<std::string, wrinkle::JointRole, std::less<>> stated_;  // by the package; may be empty
};

// Retargets by role where both skeletons have the role, and by equal names otherwise.
[[nodiscard]] wrinkle::Retarget MakeRetarget(const SkeletonMatch& match,
                                             const wrinkle::Skeleton& stream,
                                             const wrinkle::Skeleton& character);

// Describe() of the stream's roles, with the axes of the rest pose if they are not Furrow's: "...;
// the rest pose faces -X, up is +Z". Empty for a stream without joints.
[[nodiscard]] std::string Describe(const SkeletonMatch& match);
// The warning about a rest pose without a stance: what is assumed, and the way out.
[[nodiscard]] std::string UnknownAxes();
// Probable faults of a match, those of its fit among them, one sentence each, with what to do.
[[nodiscard]] std::vector<std::string> WarningsOf(const SkeletonMatch& match);

}  // namespace furrow::rig
