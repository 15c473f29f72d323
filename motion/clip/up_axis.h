// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/clip/clip.h"

namespace furrow::motion {

// Infers from the rest pose which axis points up.
//
// Up is Z if the first joint with "head" in its name (any case) is further from the root along Z
// than along Y. Otherwise, and without such a joint, up is Y. MakeHuman and 3ds Max write Z-up BVH
// files, most other tools Y-up ones.
[[nodiscard]] UpAxis FindUpAxis(const wrinkle::Skeleton& skeleton);

// Turns a Z-up clip that faces -Y to Furrow's model space: Y up, facing +Z. Every joint's
// translation and local axes turn, so joints without a rest rotation still have none.
//
// Errors: those of Skeleton::Create(), which a valid clip never causes.
[[nodiscard]] Status TurnZUpToYUp(Clip* clip);

// True if the rest pose stands along Y and the motion along Z, as in files whose writer turned the
// root instead of the rest pose. Precondition: FindUpAxis() of the skeleton is kY.
//
// In nine of ten frames, the head is above the root along Z (within 45 degrees), and the lowest
// joint along Z is near the floor, height 0: within a quarter of the rest pose's reach below the
// root. The floor tells a standing performer from one who lies with the head towards +Z.
[[nodiscard]] bool MovesAlongZ(const Clip& clip);

// Turns the motion of such a clip upright and leaves the rest pose as it is: only roots turn.
void TurnMotionUpright(Clip* clip);

}  // namespace furrow::motion
