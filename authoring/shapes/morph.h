// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "character/mesh/mesh.h"

namespace furrow::authoring {

// The positions of a mesh's vertices with its morph targets applied, before skinning (metres, model
// space, rest pose). `weights`: one per shape of the character; targets of shapes beyond its end
// rest.
[[nodiscard]] std::vector<glm::vec3> MorphedPositions(const character::Mesh& mesh,
                                                      std::span<const float> weights);

// The area-weighted normals of a surface, unit. Vertices with the same entry in `welded`
// (character::WeldVertices) share a normal. A vertex without a triangle of nonzero area gets +Z.
[[nodiscard]] std::vector<glm::vec3> SurfaceNormals(std::span<const glm::vec3> positions,
                                                    std::span<const std::uint32_t> indices,
                                                    std::span<const std::uint32_t> welded);

}  // namespace furrow::authoring
