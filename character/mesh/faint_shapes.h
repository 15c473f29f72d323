// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "character/mesh/mesh.h"

namespace furrow::character {

// The longest move of a vertex, in head heights, below which a shape counts as absent: 0.02 mm of a
// head of 230 mm. Exporters write such noise for shapes that they do not have.
inline constexpr float kLeastShapeMove = 1e-4f;

// Removes shapes that hardly move anything, so that fallbacks can take their place, and returns
// their names in order. A name proves nothing: some avatars carry all of ARKit's names.
//
// The head's height is the largest extent of what all shapes move together, in the rest pose. That
// is about a head, and more if shapes also change the body. Shapes that turn normals and move no
// position at all stay: they only shade. `meshes`: all in the same space.
std::vector<std::string> DropFaintShapes(std::vector<std::string>* shapes,
                                         std::vector<Mesh>* meshes);

}  // namespace furrow::character
