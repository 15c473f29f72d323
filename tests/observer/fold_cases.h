// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "wrinkle/skeleton/pose.h"

// The wrinkles of a rig that an observer looks at. Everything comes from the rig: its regions, its
// maps, and the poses at which its drivers are full (wrinkle::FullPose).
namespace furrow::observer {

// Wrinkle weights in a pose, and the regions that they fold.
struct FoldCase {
  std::string name;                  // "brow_l.squash" (a weight) or "elbow_l.flexed" (a bend)
  std::vector<std::size_t> regions;  // indices into Rig::regions: where folds are looked for
  wrinkle::LocalPose pose;
  std::vector<float> shapes;           // weights of the character's shapes; empty: all 0
  std::vector<float> wrinkle_weights;  // all of the rig, [0, 1]; 0 except those of the case
  // The side of the body that the posed joints are on: 1: the subject's left, -1: right, 0: middle.
  int side = 0;
};

// One case per feed of a region that is not cloth: its wrinkle weight is 1, and all others are 0.
// The pose is the full pose of the feed's source with the largest gain that has one; without such a
// source, the rest pose. A driver of a blend shape poses the character's shape of that name, if
// there is one. A map is cloth if its `surface` is. Errors: those of FullPose(), except
// kUnsupported.
[[nodiscard]] Result<std::vector<FoldCase>> FaceCases(const character::Character& character);

// One case per full bend of a joint: each value of a driver that feeds a map for cloth.
//
// - The regions of a case are all regions of cloth that any value of the driver feeds. A joint's
//   inside and outside therefore count together.
// - The weights are those that the solver computes in the pose, for those regions.
// - A pose must turn a joint by at least 20 degrees to count as a bend. A straight limb does not.
// - A bend without any weight in its regions is not a case: the rig does not fold it. `unfolded`
//   (may be null) receives the names of such bends that feed a map.
//
// Errors: those of FullPose(), except kUnsupported, and of RigBinding::Create().
[[nodiscard]] Result<std::vector<FoldCase>> BendCases(const character::Character& character,
                                                      std::vector<std::string>* unfolded);

}  // namespace furrow::observer
