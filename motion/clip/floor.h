// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/clip/clip.h"

namespace furrow::motion {

// Raises a clip whose performer is far below the floor, height 0, onto it, as in files whose origin
// is the performer's hips: MakeHuman writes such poses. True if that changes a position that the
// motion states: a root that stays at rest states none.
//
// "Far" is a quarter of the distance from the root down to the feet at rest. The lowest joint of
// all frames then touches the floor, and so does that of the rest pose. Clips of a skeleton without
// legs stay as they are: their root says nothing about a floor. Legs are those of FindTrunk(), or
// any joints that far below the root of a head.
//
// Errors: those of Skeleton::Create(), which a valid clip never causes.
[[nodiscard]] Result<bool> RaiseToFloor(Clip* clip);

}  // namespace furrow::motion
