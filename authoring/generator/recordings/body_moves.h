// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/recordings/frame_pose.h"

// Motions of the body in recordings. `t`: seconds since the start of the recording.
namespace furrow::authoring {

// Poses a standing body: hanging arms, relaxed fingers, breathing, and a head that drifts by a few
// degrees.
void Stand(float t, FramePose* pose);

// Adds a walk to Stand(): 1.04 m/s along +Z, two steps every 10/9 s. The standing foot does not
// move on the floor. Every cycle is the same.
void Walk(float t, FramePose* pose);

// Adds 12 s of motion to Stand(): a squat in which both hands reach for something on the floor and
// close around it, then a rise with the hands overhead, then leaning and turning to both sides.
void SquatAndReach(float t, FramePose* pose);

}  // namespace furrow::authoring
