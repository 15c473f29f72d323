// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/status.h"
#include "gltf/animation/animation.h"
#include "gltf/animation/vrm_animation.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"
#include "wrinkle/skeleton/skeleton.h"

// The joints of a glTF animation; private to motion/gltf/.
namespace furrow::motion {

struct GltfSkeleton {
  wrinkle::Skeleton skeleton;
  std::vector<int> joint_of_node;  // per node: joint of `skeleton`, or kNoJoint
};

// Chooses joints as ParseGltfAnimation() describes. `scale` multiplies every length.
//
// A skeleton without joints is valid: the file may animate morph weights alone. Errors: kLimit
// (wrinkle::kMaxJoints), Skeleton::Create()'s.
[[nodiscard]] Result<GltfSkeleton> BuildGltfSkeleton(gltf::Document* document,
                                                     const gltf::NodeForest& forest,
                                                     const gltf::VrmAnimation& vrm,
                                                     const gltf::Animation& animation, float scale);

}  // namespace furrow::motion
