// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "authoring/import/model/joint_finder.h"
#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A skeleton, and which joint of it is what.
struct KnownSkeleton {
  const wrinkle::Skeleton* skeleton = nullptr;
  const FoundJoints* joints = nullptr;
};

struct RigProposal {
  wrinkle::Rig rig;
  std::vector<std::string> remarks;  // what was carried over to where, what was not, what to edit
};

// Proposes a wrinkle rig for `target` from one that works on another skeleton.
//
// - Clothing: hinges, balls and twists go to the joints of the same roles. A hinge's axis is that
// of
//   a knee that bends backwards, of an elbow that bends forwards and up, across the bone as it lies
//   in the target's rest pose; angles are `model`'s.
// - Face: control points go to the joint that lies where the model's does, measured in distances
//   between the eyes from the point between them; reference poses with them. A driver that finds no
//   joint within two fifths of that distance is left out.
// - Regions keep those feeds whose drivers are there; masks become skin weights (kind `skinning`),
//   since painted masks belong to one mesh. Wrinkle maps lose their pictures: `furrow bake` makes
//   them.
// - The target must stand up, +Y, and face +Z (character_space.h).
// Errors: kNotFound where nothing can be carried over: no joint has a role.
[[nodiscard]] Result<RigProposal> ProposeRig(const wrinkle::Rig& rig, const KnownSkeleton& model,
                                             const KnownSkeleton& target);

}  // namespace furrow::authoring
