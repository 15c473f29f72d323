// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "motion/bvh/bvh_hierarchy.h"
#include "motion/clip/clip.h"

namespace furrow::motion {

// BvhPositions::kAuto, for a clip that was read as kReplace.
//
// Some exporters write position channels for every joint and leave them 0, or nearly so: MakeHuman
// does for most of its poses. If they replaced the offsets, all joints would lie in one place. So
// if most joints below a root that have an OFFSET and position channels stay within a hundredth of
// the OFFSET of 0 in every frame, the channels are added to the OFFSET. `report` then gets a
// warning, and may be null.
void AddPositionsThatCollapse(const BvhHierarchy& hierarchy, float scale,
                              std::string_view source_name, Clip* clip, ClipReport* report);

}  // namespace furrow::motion
