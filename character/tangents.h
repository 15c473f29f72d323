// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "character/character.h"

namespace furrow::character::paint {

// Smooth normals: of the triangles around each vertex, by area. Vertices that no triangle with
// extent touches point along +Z. `indices`: three a triangle, all in range.
void ComputeNormals(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

// Tangents along increasing u, of the triangles around each vertex by their UV gradients, made
// orthogonal to the unit normals that must be there; w so that cross(normal, tangent) * w points up
// the picture (decreasing v), as glTF's green-up normal maps need. Where UVs have no extent: any
// unit vector across the normal.
void ComputeTangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

}  // namespace furrow::character::paint
