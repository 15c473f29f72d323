// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// The rest places of some joints of the skeleton on which a rig's lengths were measured.
//
// Streams of one character differ in their joints: one has fingers, another has only a head. The
// sum of all bones (SkeletonSize()) changes with them, the distances between shared joints do not.
struct SizeReference {
  struct Joint {
    std::string name;
    glm::vec3 position{0.0f};  // model space, rest pose
  };
  float size = 0.0f;          // SkeletonSize() of the complete skeleton, in the units of `position`
  std::vector<Joint> joints;  // no name twice
};

// The SkeletonSize() that the reference's skeleton would have at the scale of `skeleton`:
// `reference.size` times the ratio of the spreads (root mean square distance from the centroid) of
// the joints that both have by name. SkeletonSize(skeleton) if `reference` is null, if fewer than 4
// joints are shared (or than all, if the reference has fewer), or if they lie in one place.
[[nodiscard]] float SkeletonSizeBy(const SizeReference* reference, const Skeleton& skeleton);

// The rest places of those `joints` that `skeleton` has, with its SkeletonSize().
[[nodiscard]] SizeReference MakeSizeReference(const Skeleton& skeleton,
                                              const std::set<std::string>& joints);

}  // namespace furrow::wrinkle
