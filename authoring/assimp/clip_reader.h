// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <assimp/scene.h>

#include "base/status.h"
#include "motion/clip/clip.h"

namespace furrow::authoring {

// Reads one animation of a scene that ReadScene() read for Purpose::kAnimation.
//
// - `animation`: its name, or its index from 0; empty: the first.
// - Joints: the bones of all meshes, all nodes that move, their ancestors, and the other nodes of
//   the same trees that carry no mesh. Their rest pose is the file's own transform of each node.
// - Lengths are in metres and +Y is up, as the file states its unit and axes. The scale of the
//   scene goes into the lengths, not into a joint.
// - Frames: the times of all keys together, from 0 to the animation's duration.
// - Blend shapes: the animated ones, 0 to 1.
// - `report` receives warnings and the list of all animations.
//
// Errors: kSchema (no animation, keys out of order, nothing moves), kNotFound (no such animation;
// lists them), kLimit, kNonFinite, Skeleton::Create()'s.
[[nodiscard]] Result<motion::Clip> ReadClip(const aiScene& scene, const std::string& animation,
                                            motion::ClipReport* report);

}  // namespace furrow::authoring
