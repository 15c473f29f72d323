// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "character/character.h"
#include "rig/skeleton_map.h"

namespace furrow::authoring {

// A body of boxes, 1.7 m high in a T-pose, +Y up and facing +Z: 19 joints with VRM's names, and a
// box around each joint. Half of a box's vertices also follow the parent joint. UVs do not overlap.
[[nodiscard]] character::Character ToyBody();

// The shipped skeleton map for VRM's names.
[[nodiscard]] rig::SkeletonMaps VrmMaps();

// Returns a character as a .glb file.
[[nodiscard]] std::string GlbOf(const character::Character& character);

// Converts a .glb with assimp. `format` is the name of assimp's exporter: "fbxa" (ASCII FBX) or
// "collada". assimp 5.2 cannot read the binary FBX files that it writes.
[[nodiscard]] std::string ConvertByAssimp(std::string_view glb, const std::string& format);

}  // namespace furrow::authoring
