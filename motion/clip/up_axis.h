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

}  // namespace furrow::motion
