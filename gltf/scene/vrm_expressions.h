// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/status.h"
#include "gltf/document/document.h"

namespace furrow::gltf {

// An expression of a VRM avatar: morph targets that move together under one name.
struct VrmExpression {
  struct Bind {
    int mesh = 0;         // index of a mesh
    int target = 0;       // index of one of its morph targets
    float weight = 0.0f;  // at an expression of 1; (0, 1]
  };
  std::string name;  // "joy" (VRM 0.x), "happy" (VRM 1.0), or the author's own name
  std::vector<Bind> binds;
};

// Reads the expressions of VRM 0.x (VRM.blendShapeMaster.blendShapeGroups) and 1.0
// (VRMC_vrm.expressions) of a document with Contents::kCharacter. Expressions without morph targets
// are left out. Binds add up (VRMC_vrm-1.0, "Expressions"). ReadExpressionRules() and
// ReadMaterialBinds() have what else they do.
//
// Binds of meshes or targets that do not exist are ignored with a warning.
// Error: kLimit (gltf/limits.h).
[[nodiscard]] Result<std::vector<VrmExpression>> ReadVrmExpressions(Document* document);

}  // namespace furrow::gltf
