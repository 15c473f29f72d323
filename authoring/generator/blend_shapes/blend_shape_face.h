// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"
#include "character/character.h"
#include "wrinkle/rig/rig.h"

namespace furrow::authoring {

// Turns the jointed face of a generated character into one of blend shapes: adds ARKit's 52 shapes
// (AddFaceShapes()), removes the face's joints and adapts the rig (BlendShapeRig()). Pictures stay,
// so wrinkle maps are baked before. Neck, head and body keep their joints. The eyes have no joints
// afterwards; the shapes eyeLook* turn them.
//
// Differences from the jointed face on a stream of ARKit's blend shapes:
// - Wrinkle weights: none.
// - Each shape alone at 1 gives the same positions, except tongueOut (the tongue comes out) and
//   mouthClose, which acts on an open jaw only (AddFaceShapes()). At other coefficients, jaw, lids
//   and eyes move along straight lines instead of arcs; a half-closed lid is up to 0.8 mm lower on
//   the eye's curve.
// - Shapes add up. A joint below another joint adds up only where its parent rests: lips that move
//   on an open jaw differ by up to the jaw's turn, 20 degrees, of their own motion.
// Errors: those of AddFaceShapes(); kNotFound (no joint "head").
[[nodiscard]] Status MakeBlendShapeFace(character::Character* character);

// The rig of such a face: the drivers of blend shapes and of the body's joints, and the regions
// that they feed. Drivers of face joints and reference poses are left out.
[[nodiscard]] wrinkle::Rig BlendShapeRig(const wrinkle::Rig& rig);

}  // namespace furrow::authoring
