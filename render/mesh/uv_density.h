// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::render {

// How far UV goes over a metre of a mesh in its rest pose, along the direction in which it goes
// furthest, where a texture is stretched most; outliers, a twentieth of the surface, are left out.
// 0: there is no surface.
[[nodiscard]] float LeastUvPerMetre(const character::Mesh& mesh);

}  // namespace furrow::render
