// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"
#include "rig/shapes/shape_match.h"

namespace furrow::authoring {

// The mouthClose of ARKit closes the lips on a jaw that jawOpen opens. That of other tools
// (NVIDIA's Audio2Face, SRanipal's Mouth_Ape_Shape) opens the jaw itself. Both have the same names,
// so the chin tells: if the shape that means mouthClose moves the chin by at least half as far as
// the one that means jawOpen, and in its direction, it contains it.
//
// Notes that in the character's shape rules (wrinkle::ShapeRule::contains), which a package keeps.
// `character`: upright (+Y). Returns true if mouthClose contains jawOpen.
bool NoteContainedJaw(const rig::ShapeMatcher& matcher, character::Character* character);

}  // namespace furrow::authoring
