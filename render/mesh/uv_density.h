// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::render {

// The smallest UV distance per metre of surface where the texture is stretched most, measured per
// triangle along its densest direction, in the rest pose. Ignores the most stretched twentieth of
// the surface as outliers. 0: the mesh has no surface.
[[nodiscard]] float MinUvPerMetre(const character::Mesh& mesh);

}  // namespace furrow::render
