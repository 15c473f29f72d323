// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rig/skeleton_map.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::rig {

// How the joints of a stream or recording correspond to a rig and to a character.
struct SkeletonMatch {
  SkeletonRoles stream;
  SkeletonRoles character;  // empty without a character
  // For BindOptions::aliases: (the rig's joint, the stream's joint of the same role).
  std::vector<std::pair<std::string, std::string>> aliases;
};

// Finds the roles of a stream's joints with the shipped maps and, if requested, one more.
class SkeletonMatcher {
 public:
  SkeletonMatcher() = default;  // no maps: joints match by equal names only

  // `name_or_file` is the map for every stream (SkeletonMaps::Load()); empty selects the best
  // shipped map per stream. A character's map is chosen among the shipped maps and that one.
  [[nodiscard]] static Result<SkeletonMatcher> Create(const std::string& name_or_file);

  // `character` may be null. It does not affect the aliases, so weights are the same with and
  // without pictures. The map that explains the most joint names of the rig gives their roles.
  // Joints that have the same name in the stream and in the rig get no alias.
  [[nodiscard]] SkeletonMatch Match(const wrinkle::Skeleton& stream, const wrinkle::Rig& rig,
                                    const wrinkle::Skeleton* character) const;

 private:
  SkeletonMaps streams_;
  SkeletonMaps characters_;
};

// Retargets by role where both skeletons have the role, and by equal names otherwise.
[[nodiscard]] wrinkle::Retarget MakeRetarget(const SkeletonMatch& match,
                                             const wrinkle::Skeleton& stream,
                                             const wrinkle::Skeleton& character);

// One line for a log: "skeleton map 'cmu': 22 roles; missing: leftToes, rightToes". Fingers, eyes
// and jaw are listed as missing only if some of them are present. Empty if no map fits the
// skeleton.
[[nodiscard]] std::string Describe(const SkeletonRoles& roles);

}  // namespace furrow::rig
