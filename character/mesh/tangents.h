// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "character/mesh/mesh.h"

namespace furrow::character::paint {

// Computes smooth normals: the area-weighted mean of the triangles around each vertex. A vertex
// without a triangle of non-zero area gets +Z. `indices` holds three per triangle, all in range.
void ComputeNormals(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

// Computes tangents along increasing u from the UV gradients of the triangles around each vertex.
// Precondition: unit normals. Tangents are orthogonal to them, and cross(normal, tangent) * w
// points up the picture (decreasing v), as glTF's green-up normal maps require. A vertex whose UVs
// have no area gets any unit vector perpendicular to the normal.
void ComputeTangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

}  // namespace furrow::character::paint
