// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "character/character.h"

namespace furrow::authoring {

// Returns the index in Character::shapes of the shape that means what ARKit's blend shape `name`
// means; -1 if there is none.
using ShapeFinder = std::function<int(std::string_view name)>;

// Finds shapes by ARKit's names, written in any common way: "mouthSmileLeft", "mouthSmile_L",
// "Mouth_Smile_Left" and "head|mouthSmileLeft" are the same shape. What precedes the last ':', '|'
// or '.' does not count. `character`: only its names are used, and they are copied.
[[nodiscard]] ShapeFinder FindShapesByName(const character::Character& character);

// The key by which FindShapesByName() compares names: lowercase letters and digits, with the sides
// spelled out ("mouthsmileleft").
[[nodiscard]] std::string ShapeKey(std::string_view name);

}  // namespace furrow::authoring
