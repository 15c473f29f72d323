// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "character/mesh/mesh.h"
#include "wrinkle/shapes/joint_shapes.h"

namespace furrow::character {

// The vertices that morph targets move, with their motion per shape.
[[nodiscard]] wrinkle::MovedSurface FindMovedSurface(std::span<const Mesh> meshes);

}  // namespace furrow::character
