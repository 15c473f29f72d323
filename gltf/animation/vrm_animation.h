// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"

namespace furrow::gltf {

// The extension VRMC_vrm_animation 1.0 of a .vrma file.
struct VrmAnimation {
  bool present = false;
  std::vector<std::pair<std::string, int>> human_bones;  // VRM's joint name ("hips"), node
  std::vector<std::pair<std::string, int>> expressions;  // the node's translation.x is the value
  int look_at = kNone;                                   // node
};

// Reads the extension of a document with Contents::kAnimation; `present` is false without it.
// Errors: kSchema (a node that does not exist), kLimit (kMaxVrmNodes).
[[nodiscard]] Result<VrmAnimation> ReadVrmAnimation(const Document& document);

}  // namespace furrow::gltf
