// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "character/character.h"

namespace furrow::authoring {

// A body of boxes, 1.7 m high in a T-pose, +Y up and facing +Z: 19 joints with VRM's names, a box
// around each, half of whose vertices follow the joint above, too; UVs without overlap.
[[nodiscard]] character::Character ToyBody();

// A character as a .glb.
[[nodiscard]] std::string GlbOf(const character::Character& character);

// A .glb converted by assimp: `format` is its exporter ("fbxa" for ASCII FBX, "collada"; the
// binary FBX that assimp 5.2 writes cannot be read by itself).
[[nodiscard]] std::string ConvertByAssimp(std::string_view glb, const std::string& format);

}  // namespace furrow::authoring
