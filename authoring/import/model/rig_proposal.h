// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "authoring/import/model/joint_finder.h"
#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A skeleton with the roles of its joints. Both pointers are not null and must stay valid during
// the call.
struct KnownSkeleton {
  const wrinkle::Skeleton* skeleton = nullptr;
  const FoundJoints* joints = nullptr;
};

// A proposed rig.
struct RigProposal {
  wrinkle::Rig rig;
  // One sentence each: what was transferred to which joint, what was not, and what to edit.
  std::vector<std::string> remarks;
  bool joints_are_guessed = false;  // from the hierarchy, because no map fits
};

// Proposes a wrinkle rig for the skeleton `target` from `rig`, which works on the skeleton `model`.
//
// - Clothing: hinges, balls and twists move to the joints with the same roles. The axis of a hinge
//   follows from the target's rest pose: knees bend backward, elbows forward and up. Angles stay as
//   in the model's rig.
// - Face: control points move to the joint at the same position relative to the eyes
//   (MatchFaces()), and reference poses move with them. A driver without a match is left out.
// - Regions keep the feeds that still have drivers. Masks become skin weights (kind `skinning`),
//   since painted masks belong to one mesh. Wrinkle maps lose their pictures, which `furrow bake`
//   makes again.
// - The target must be upright (+Y) and face +Z; FindCharacterSpace() gives the rotation.
// Errors: kNotFound (no joint has a role, so nothing can be transferred).
[[nodiscard]] Result<RigProposal> ProposeRig(const wrinkle::Rig& rig, const KnownSkeleton& model,
                                             const KnownSkeleton& target);

}  // namespace furrow::authoring
