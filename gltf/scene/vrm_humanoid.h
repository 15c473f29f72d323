// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gltf/document/document.h"

namespace furrow::gltf {

// Reads the human bones of a VRM avatar: pairs of VRM 1.0's name of the bone ("leftUpperArm") and
// its node, in the order of the file. Names of VRM 0.x are translated, unknown ones kept. Empty for
// other files.
//
// Entries without a node of the file, second entries of a bone, and entries after the first
// kMaxVrmNodes are left out, with a warning. So is a jaw whose node is not called one: editors pick
// a joint of the hair for it if they find no better one.
[[nodiscard]] std::vector<std::pair<std::string, int>> ReadVrmHumanoid(Document* document);

}  // namespace furrow::gltf
