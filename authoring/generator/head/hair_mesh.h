// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// Makes the hair of a head: a thin cap over the scalp, and on it one textured strip ("card") per
// lock of hair.
[[nodiscard]] HeadMesh MakeHair(const HeadShape& shape = DefaultHead());

}  // namespace furrow::authoring
