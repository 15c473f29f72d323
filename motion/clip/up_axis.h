// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/clip/clip.h"

namespace furrow::motion {

// Infers from the rest pose which axis points up: kY or kZ, or kAuto if the rest pose does not
// tell.
//
// - Up is away from the feet, if the hierarchy shows a body on two or four legs (FindTrunk()).
// - Without such legs, up leads from the root to the first joint with "head" in its name.
// - MakeHuman and 3ds Max write Z-up BVH files, most other tools Y-up ones.
[[nodiscard]] UpAxis FindUpAxis(const wrinkle::Skeleton& skeleton);

// True if the skeleton extends further along Z than along Y at rest. If FindUpAxis() does not know,
// such a skeleton may be Z-up.
[[nodiscard]] bool IsLongestAlongZ(const wrinkle::Skeleton& skeleton);

// Turns a Z-up clip that faces -Y to Furrow's model space: Y up, facing +Z. Every joint's
// translation and local axes turn, so joints without a rest rotation still have none.
//
// Errors: those of Skeleton::Create(), which a valid clip never causes.
[[nodiscard]] Status TurnZUpToYUp(Clip* clip);

// True if the rest pose stands along Y and the motion along Z, as in files whose writer turned the
// root instead of the rest pose. Precondition: FindUpAxis() of the skeleton is not kZ.
//
// In nine of ten frames, the head is above the root along Z (within 45 degrees), and the lowest
// joint along Z is near the floor, height 0: within a quarter of the rest pose's reach below the
// root. The floor tells a standing performer from one who lies with the head towards +Z. False for
// a body on four legs, which points its head ahead.
[[nodiscard]] bool MovesAlongZ(const Clip& clip);

// Turns the motion of such a clip upright and leaves the rest pose as it is: only roots turn.
void TurnMotionUpright(Clip* clip);

}  // namespace furrow::motion
