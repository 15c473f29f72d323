// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "character/character.h"
#include "motion/clip/clip.h"

namespace furrow::cli {

// A clip of one frame on the character's own skeleton: its rig's reference poses, added up.
//
// `text`: "NAME[=WEIGHT],..." with weights in [-4, 4], 1 where none is given; or "neutral". A NAME
// is a reference pose; one that comes in two sides may leave out "_l" and "_r"; or a wrinkle map,
// which stands for every pose that feeds it. Errors: kNotFound (lists what there is), kParse.
[[nodiscard]] Result<motion::Clip> PoseClip(const character::Character& character,
                                            const std::string& text);

}  // namespace furrow::cli
