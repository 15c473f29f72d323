// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::character {

// Smooth normals: of the triangles around each vertex, by area. Vertices that no triangle with
// extent touches point along +Z.
void ComputeNormals(Mesh* mesh);

// Tangents along increasing u, of the triangles around each vertex by their UV gradients, made
// orthogonal to the unit normals that must be there; w so that cross(normal, tangent) * w points up
// the picture (decreasing v), as glTF's green-up normal maps need. Where UVs have no extent: any
// unit vector across the normal.
void ComputeTangents(Mesh* mesh);

}  // namespace furrow::character
