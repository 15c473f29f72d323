// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "character/mesh/mesh.h"

namespace furrow::character::paint {

// Sets each vertex's normal to the normalised, area-weighted mean of the normals of its triangles.
// Normals point to the side from which the triangles appear counter-clockwise. A vertex without a
// triangle of non-zero area gets +Z. `indices`: three vertex indices per triangle, all in range.
void ComputeNormals(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

// Sets each vertex's tangent: xyz is the unit direction in which u increases, perpendicular to the
// normal; w is the handedness of the UVs, 1 or -1 (mirrored). cross(normal, xyz) * w is the
// bitangent, which points up in the texture image (towards smaller v), as glTF's normal maps
// require. Directions are averaged over the vertex's triangles, weighted by area. If their UVs have
// no area, xyz is any unit vector perpendicular to the normal. `indices`: three per triangle, all
// in range. Precondition: unit normals.
void ComputeTangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

}  // namespace furrow::character::paint
