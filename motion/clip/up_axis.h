// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/clip/clip.h"

namespace furrow::motion {

// Which axis of a recording points up: kAuto's answer is looked for in its rest pose.
//
// A joint whose name contains "head" (any case) stands above the root: if it does so along Z rather
// than Y, up is Z. Without such a joint, Y. MakeHuman and 3ds Max write Z-up BVH, most others Y-up.
[[nodiscard]] UpAxis FindUpAxis(const wrinkle::Skeleton& skeleton);

// Turns a Z-up clip (facing -Y) to Y up, facing +Z, which all of Furrow means by model space: every
// translation and every local frame turns, so rest rotations that were none stay none.
//
// Errors: Skeleton::Create()'s, which a valid clip does not meet.
[[nodiscard]] Status TurnZUpToYUp(Clip* clip);

}  // namespace furrow::motion
