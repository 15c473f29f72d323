// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/recordings/frame_pose.h"

// What the body does in recordings, by the time in seconds.
namespace furrow::authoring {

// Arms hang, fingers are relaxed; the chest breathes; the head drifts by a few degrees.
void Stand(float t, FramePose* pose);

// Over Stand(): 1.04 m a second along +Z, a cycle of two steps every 10/9 s. The foot that carries
// stays where it is on the floor; the pose is the same every cycle.
void Walk(float t, FramePose* pose);

// Over Stand(), 12 s: down on the haunches, both hands reach for something on the floor and close
// round it, up again and overhead with it; then the trunk leans and turns to either side.
void SquatAndReach(float t, FramePose* pose);

}  // namespace furrow::authoring
