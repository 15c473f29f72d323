// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "character/character.h"

namespace furrow::character::paint {

// Tangents from UVs, per vertex, glTF's way: along increasing u, with w so that the bitangent
// cross(normal, tangent) * w points up the picture (decreasing v).
//
// `vertices` with unit normals and UVs, `indices` three a triangle. Vertices without UV area around
// them get some unit tangent across their normal.
void ComputeTangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

}  // namespace furrow::character::paint
