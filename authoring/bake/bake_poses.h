// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "authoring/bake/bake.h"

namespace furrow::character::bake {

// What a rig's drivers have to give to a bake.
struct PosesToBake {
  std::vector<BakePose> poses;
  // What feeds a map and cannot be baked, one sentence each: blend shapes and strain drivers, which
  // no pose of joints answers for, and limbs that are as straight at rest as they can get.
  std::vector<std::string> notes;
};

// For every region and wrinkle map of the character's rig, the poses that feed it at their fullest
// (wrinkle/rig/full_pose.h), skinned: model matrix times inverse bind matrix. A source's gain, at
// most 1, becomes the pose's weight. `maps` (names; empty: all) says which maps are wanted.
//
// Errors: kNotFound (no rig; a map that it has not; a joint that the skeleton has not),
// kInvalidArgument (a reference pose equal to the rest pose: it cannot fold anything; a driver that
// makes no sense on this skeleton). `where` is the rig's field, "regions[3].feeds[0].sources[1]".
[[nodiscard]] Result<PosesToBake> PosesOf(const Character& character,
                                          std::span<const std::string> maps = {});

}  // namespace furrow::character::bake
