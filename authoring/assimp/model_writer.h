// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <assimp/scene.h>

#include "base/status.h"

namespace furrow::authoring {

// Converts a scene that ReadScene() read for Purpose::kModel to binary glTF: the character that
// ReadWithAssimp() describes. Appends a sentence to `remarks` for everything that was converted or
// lost. Errors: kSchema (a bone of a missing joint), kUnsupported (no mesh), kLimit.
[[nodiscard]] Result<std::string> WriteModel(const aiScene& scene,
                                             std::vector<std::string>* remarks);

}  // namespace furrow::authoring
