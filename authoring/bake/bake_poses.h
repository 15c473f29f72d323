// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "authoring/shapes/arkit_face.h"
#include "character/character.h"

namespace furrow::authoring {

// The poses of a rig that a bake can use.
struct CollectedPoses {
  std::vector<BakePose> poses;
  // Drivers that feed a map but have no pose to bake, one sentence each: blend shapes that the
  // character lacks, strain drivers, and limbs that are fully straight at rest.
  std::vector<std::string> notes;
};

// Collects, for every region and wrinkle map of the character's rig, the poses that feed the map at
// full strength. The skin matrix of a joint is its posed model matrix times its inverse bind
// matrix. The gain of a source in the rig, limited to 1, becomes the weight of the pose. `maps`:
// names of the maps to collect poses for; empty: all.
//
// The blend shapes of a reference pose move what a stream's would: the shapes that `face` names, or
// joints by the rig's reference poses (wrinkle::BlendShapePose).
//
// A driver of a blend shape poses the character's shapes that `face`, made from the character,
// names for it (default: equal names). Such a feed also gets the combinations (ShapeCombinations())
// that its shapes lead. Shapes with a gain below 0.7 give no pose: they show the folds of the
// others.
//
// A feed with `angles` is posed at the first angle of its largest weight, which may be the rest
// pose. Its sources with a gain below 0.6 give no pose. `path` begins at the reference pose
// wrinkle::kClothesFitPose, if the rig has one.
//
// Errors: kNotFound (no rig; a map that the rig lacks; a joint that the skeleton lacks),
// kInvalidArgument (a reference pose equal to the rest pose, which cannot fold anything; a driver
// that does not fit the skeleton). `where` is a field of the rig: "regions[3].feeds[0].sources[1]".
[[nodiscard]] Result<CollectedPoses> CollectBakePoses(const character::Character& character,
                                                      std::span<const std::string> maps = {});
[[nodiscard]] Result<CollectedPoses> CollectBakePoses(const character::Character& character,
                                                      std::span<const std::string> maps,
                                                      const ArkitFace& face);

}  // namespace furrow::authoring
