// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rig/skeleton_map.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::character {

// How a stream's (or a recording's) skeleton is seen by a rig and by a character.
struct SkeletonMatch {
  SkeletonRoles stream;
  SkeletonRoles character;  // empty without one
  // For BindOptions::aliases: (the rig's joint, the stream's joint of the same role).
  std::vector<std::pair<std::string, std::string>> aliases;
};

// Finds out what the joints of streams are, by the maps that ship and one more if it is asked for.
class SkeletonMatcher {
 public:
  SkeletonMatcher() = default;  // no maps: joints are matched by equal names alone

  // `name_or_file`: the map that holds for every stream, see SkeletonMaps::Load(); empty: the best
  // of those that ship. A character's own map is found among those that ship and that one.
  [[nodiscard]] static Result<SkeletonMatcher> Create(const std::string& name_or_file);

  // `character` may be null: it changes no alias, so weights are the same with and without
  // pictures. A rig's joints are known by the map that explains their names best; joints that the
  // stream has by the rig's own name get no alias.
  [[nodiscard]] SkeletonMatch Match(const wrinkle::Skeleton& stream, const wrinkle::Rig& rig,
                                    const wrinkle::Skeleton* character) const;

 private:
  SkeletonMaps streams_;
  SkeletonMaps characters_;
};

// By role as far as both are known, the rest by equal names.
[[nodiscard]] wrinkle::Retarget MakeRetarget(const SkeletonMatch& match,
                                             const wrinkle::Skeleton& stream,
                                             const wrinkle::Skeleton& character);

// One line for a log: "skeleton map 'cmu': 22 roles; not there: leftToes, rightToes". Fingers, eyes
// and jaw are only told of where some of them are there. Empty where no map knows the skeleton.
[[nodiscard]] std::string Describe(const SkeletonRoles& roles);

}  // namespace furrow::character
