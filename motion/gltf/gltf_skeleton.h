// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "motion/gltf/gltf_document.h"
#include "wrinkle/skeleton/skeleton.h"

// Which nodes of a glTF file are joints, and what they are
// called; private to motion/'s glTF reader.
namespace furrow::motion {

struct ClipReport;

// What VRMC_vrm_animation says about nodes.
struct VrmAnimation {
  bool present = false;
  std::vector<std::pair<std::string, int>> human_bones;  // VRM's name, node
  std::vector<std::pair<std::string, int>> expressions;
  int look_at = -1;  // node
};

[[nodiscard]] Result<VrmAnimation> ReadVrmAnimation(const GltfDocument& document);

struct GltfSkeleton {
  wrinkle::Skeleton skeleton;
  std::vector<int> joint_nodes;  // node of every joint, in the skeleton's order
};

// See ParseGltfAnimation() for what becomes a joint. `moving`: nodes whose transform is animated.
// A skeleton without joints is no error: the file may animate morph weights alone.
[[nodiscard]] Result<GltfSkeleton> BuildGltfSkeleton(const GltfDocument& document,
                                                     const VrmAnimation& vrm,
                                                     const std::vector<int>& moving, float scale);

}  // namespace furrow::motion
