// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// Fewer roles than this prove nothing: two names in common are chance.
inline constexpr int kLeastRoles = 6;

// How one family of skeletons calls its joints (docs/SKELETONS.md is the manual of the file).
struct SkeletonMap {
  struct Entry {
    wrinkle::JointRole role = wrinkle::JointRole::kNone;
    // A chain from above to below; each place with its alternative names, the first found counts.
    std::vector<std::vector<std::string>> chain;
  };
  std::string name;   // "mixamo": what options and logs say
  std::string title;  // for people
  // What may stand before every name: a literal, or "*" and a literal (all up to its last
  // occurrence). A namespace ("mixamorig:", all up to the last ':') always may.
  std::vector<std::string> prefixes;
  bool ignore_case = true;
  std::optional<float> toes_height;  // see Retarget::Create()
  std::vector<Entry> entries;        // no role twice
};

// What a map finds in a skeleton.
struct SkeletonRoles {
  std::string map;                          // its name; empty: no map knows this skeleton
  wrinkle::JointRoles roles;                // one a joint; empty where `map` is
  int num_roles = 0;                        // different ones found
  int num_joints = 0;                       // that have a role
  std::optional<float> toes_height;         // the map's
  std::vector<wrinkle::JointRole> missing;  // in the map, not in the skeleton
};

// Reads a map. Errors: kParse, kSchema (field unknown, missing, of the wrong type, a role that is
// none or comes twice), kLimit (over 1 MiB, 64 prefixes, 16 joints a role, 255 bytes a name).
// `where` is "file: field".
[[nodiscard]] Result<SkeletonMap> ParseSkeletonMap(std::string_view json,
                                                   std::string_view source_name);

// The roles that `map` finds among joints of these names; `map` of the result is always set.
[[nodiscard]] SkeletonRoles ApplySkeletonMap(const SkeletonMap& map,
                                             std::span<const std::string> joint_names);

// The maps that joints are looked up in.
class SkeletonMaps {
 public:
  SkeletonMaps() = default;  // none: every skeleton is unknown
  // `chosen` true: the one map holds for every skeleton, however little it finds.
  explicit SkeletonMaps(std::vector<SkeletonMap> maps, bool chosen = false);

  // All maps that ship (share/furrow/skeleton_maps/*.json). Errors: kNotFound,
  // ParseSkeletonMap()'s.
  [[nodiscard]] static Result<SkeletonMaps> LoadShipped();
  // One map for every skeleton: a file, or the name of one that ships ("mixamo"). Empty: all that
  // ship, and the best one is found for each skeleton.
  [[nodiscard]] static Result<SkeletonMaps> Load(const std::string& name_or_file);

  // The map that explains most joints, if it finds kLeastRoles; first by name among equals.
  [[nodiscard]] SkeletonRoles RolesOf(const wrinkle::Skeleton& skeleton) const;
  [[nodiscard]] SkeletonRoles RolesOf(std::span<const std::string> joint_names) const;

  [[nodiscard]] std::span<const SkeletonMap> maps() const { return maps_; }

 private:
  std::vector<SkeletonMap> maps_;  // by name
  bool chosen_ = false;
};

// "leftToes, rightToes": for messages.
[[nodiscard]] std::string JoinRoles(std::span<const wrinkle::JointRole> roles);

}  // namespace furrow::character
