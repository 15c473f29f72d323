// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace furrow::authoring {

// The names of ARKit's 52 blend shapes in the order of Live Link Face. "Left" is the subject's
// left. `browInnerUp`, `cheekPuff` and the shapes of jaw, lips and tongue without a side move both
// sides; jawLeft, jawRight, mouthLeft and mouthRight name directions.
[[nodiscard]] std::span<const char* const> ArkitShapes();

}  // namespace furrow::authoring
