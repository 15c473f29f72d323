// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// The hair: a thin cap over the scalp and cards of strands on it, one per lock (hair_style.h).
[[nodiscard]] HeadMesh MakeHair(const HeadShape& shape = DefaultHead());

}  // namespace furrow::authoring
