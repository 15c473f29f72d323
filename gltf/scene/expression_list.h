// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "gltf/document/document.h"

namespace furrow::gltf {

// An expression of a VRM avatar, as its file states it.
struct ExpressionObject {
  enum class Version { kVrm0, kVrm1 };
  std::string name;  // the preset's, else the author's; at most kMaxNameBytes; may be empty
  bool is_preset = false;
  Version version = Version::kVrm1;
  const tinygltf::Value* json = nullptr;  // of the document; any type
};

// The expressions of VRM 0.x (VRM.blendShapeMaster.blendShapeGroups) or 1.0 (VRMC_vrm.expressions)
// of a document with Contents::kCharacter, in the file's order. Empty for other files.
[[nodiscard]] std::vector<ExpressionObject> ListExpressions(const Document& document);

}  // namespace furrow::gltf
