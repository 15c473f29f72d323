// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/status.h"
#include "character/mesh/mesh.h"

namespace furrow::character {

// Computes the normal deltas of morph targets that state positions only: N(morphed) - N(base). N is
// the mean of the triangles' normals, weighted by area, over all vertices that share a position and
// move alike in every target. So the delta is equal on both sides of a UV seam, and lips that touch
// do not share it. The mesh's own normals stay: they carry the artist's hard and soft edges.
//
// `lacking`: one flag per target of the mesh; only flagged targets change. Targets may gain deltas
// for unmoved neighbours of moved vertices, whose normals turn as well. Deltas of less than 1e-4
// are left out.
//
// Error: kLimit if all targets of the mesh together would have more than `max_deltas` deltas, or
// the work is out of proportion. The targets are incomplete then; discard them.
[[nodiscard]] Status ComputeMorphNormals(const std::vector<bool>& lacking, std::size_t max_deltas,
                                         Mesh* mesh);

}  // namespace furrow::character
