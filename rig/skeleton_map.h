// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::rig {

// A map fits a skeleton if it finds this many roles. Fewer matches may be coincidence.
inline constexpr int kMinRoles = 6;

// SkeletonRoles::map where no map gave the roles.
inline constexpr char kFromHierarchy[] = "(hierarchy)";
inline constexpr char kFromPackage[] = "(package)";  // the character's package states them

// The joint names of one family of skeletons. docs/SKELETONS.md describes the file format.
struct SkeletonMap {
  struct Entry {
    wrinkle::JointRole role = wrinkle::JointRole::kNone;
    // A chain of joints from parent to child. Each place lists alternative names; the first match
    // counts.
    std::vector<std::vector<std::string>> chain;
  };
  std::string name;   // as shown in options and logs, such as "mixamo"
  std::string title;  // for display
  // Optional prefixes of every name: a literal, or "*" and a literal, which matches everything up
  // to the literal's last occurrence. A namespace, everything up to the last ':' ("mixamorig:"), is
  // always optional.
  std::vector<std::string> prefixes;
  bool ignore_case = true;
  std::optional<float> toes_height;  // see Retarget::Create()
  std::vector<Entry> entries;        // no role twice
};

// The roles that a map finds in a skeleton.
struct SkeletonRoles {
  // The map's name; kFromHierarchy if the hierarchy tells more roles than any map; kFromPackage;
  // else empty.
  std::string map;
  wrinkle::JointRoles roles;                // one per joint; empty if `map` is empty
  int num_roles = 0;                        // distinct roles found
  int num_joints = 0;                       // joints that have a role
  std::optional<float> toes_height;         // from the map
  std::vector<wrinkle::JointRole> missing;  // in the map, but not in the skeleton
};

// The roles that a package states for a character, one per joint. `roles` must not be empty.
[[nodiscard]] SkeletonRoles RolesOfPackage(wrinkle::JointRoles roles);

// Reads a map. Errors, with "file: field" as `where`: kParse, kSchema (an unknown or missing field,
// a wrong type, an unknown or duplicate role), kLimit (more than 1 MiB, 64 prefixes, 16 joints per
// role or 255 bytes per name).
[[nodiscard]] Result<SkeletonMap> ParseSkeletonMap(std::string_view json,
                                                   std::string_view source_name);

// The roles that `map` finds among these joint names. The result's `map` is always set.
[[nodiscard]] SkeletonRoles ApplySkeletonMap(const SkeletonMap& map,
                                             std::span<const std::string> joint_names);

// A set of maps that finds the roles of a skeleton's joints.
class SkeletonMaps {
 public:
  SkeletonMaps() = default;  // no maps: every skeleton is unknown
  // `chosen`: use the single map for every skeleton, however few roles it finds.
  explicit SkeletonMaps(std::vector<SkeletonMap> maps, bool chosen = false);

  // Loads all shipped maps (share/furrow/skeleton_maps/*.json). Errors: kNotFound, and those of
  // ParseSkeletonMap().
  [[nodiscard]] static Result<SkeletonMaps> LoadShipped();
  // Loads one map for every skeleton: a file, or the name of a shipped map ("mixamo"). An empty
  // argument loads all shipped maps; then each skeleton gets the map that fits best.
  [[nodiscard]] static Result<SkeletonMaps> Load(const std::string& name_or_file);

  // The roles of the map that fits best, if it finds at least kMinRoles, and limbs among them
  // unless it explains three quarters of the joints: a trunk alone leaves arms and legs stiff.
  //
  // A joint of the body counts 4, one of fingers or face 1. With a skeleton, a joint without a role
  // between joints with roles costs 2. In a tie, the map of which more is found wins, then the one
  // that spells more names in the same case, and then the first name.
  [[nodiscard]] SkeletonRoles RolesOf(const wrinkle::Skeleton& skeleton) const;
  [[nodiscard]] SkeletonRoles RolesOf(std::span<const std::string> joint_names) const;
  // RolesOf(), or the roles that RolesFromHierarchy() finds, with fingers and face by their names,
  // if these have more of wrinkle::kEssentialRoles and confirm at least half of the limbs' joints
  // that the map names. The map's roles hold if it is chosen, and joints are matched by equal names
  // without any maps.
  [[nodiscard]] SkeletonRoles RolesOrGuess(const wrinkle::Skeleton& skeleton) const;
  // The roles of the joints that a rig names. They need no limbs: a rig of a face has none.
  [[nodiscard]] SkeletonRoles RolesOfRig(std::span<const std::string> joint_names) const;

  // The most roles that any map finds, whether it fits or not.
  [[nodiscard]] int MostRoles(std::span<const std::string> joint_names) const;

  // True if any map gives a joint of this name the role of an eye, whether the map fits or not.
  [[nodiscard]] bool KnowEye(const std::string& joint_name) const;

  [[nodiscard]] std::span<const SkeletonMap> maps() const { return maps_; }
  [[nodiscard]] bool is_chosen() const { return chosen_; }

 private:
  [[nodiscard]] SkeletonRoles Best(std::span<const std::string> joint_names,
                                   std::span<const std::int16_t> parents, bool needs_limbs) const;

  std::vector<SkeletonMap> maps_;  // sorted by name
  bool chosen_ = false;
};

// A skeleton map (JSON) with the joints of these roles: a start for a map of one's own. `roles`:
// one per joint.
[[nodiscard]] std::string ProposeSkeletonMap(std::string_view name,
                                             std::span<const std::string> joint_names,
                                             const wrinkle::JointRoles& roles);

// Joins role names for messages: "leftToes, rightToes".
[[nodiscard]] std::string JoinRoles(std::span<const wrinkle::JointRole> roles);

}  // namespace furrow::rig
