// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "character/character.h"
#include "motion/clip/clip.h"

namespace furrow::cli {

// Returns a clip with one frame on the character's skeleton: a weighted sum of the rig's reference
// poses, with their blend shapes, and of blend shapes.
//
// `text` is "neutral" or "NAME[=WEIGHT],..." with weights in [-4, 4] (default 1). NAME is a
// reference pose; a pair of poses with the suffixes "_l" and "_r", without the suffix; a wrinkle
// map, which stands for all poses that feed it; or a blend shape of ARKit, of the rig's drivers or
// of the character, in any case, of which "mouthSmile" means both sides. The pose mouthClose counts
// at most as jawOpen, and does nothing without it. Errors: kNotFound (lists the valid names),
// kParse.
[[nodiscard]] Result<motion::Clip> PoseClip(const character::Character& character,
                                            const std::string& text);

}  // namespace furrow::cli
