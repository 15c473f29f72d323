// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <glm/mat4x4.hpp>

#include "character/mesh/mesh.h"

namespace furrow::character {

// The affine matrix that moves one vertex.
using VertexMatrix = std::function<glm::mat4(const Vertex&)>;

// Moves every vertex of a mesh, with the deltas of its morph targets, by the matrix of that vertex.
// Normals follow the inverse transpose. A morphed vertex ends where the matrix takes it, for every
// weight. If a matrix mirrors, the winding of the triangles is swapped. Directions that a matrix
// flattens to zero stay as they are.
void MoveMesh(const VertexMatrix& matrix_of, Mesh* mesh);

}  // namespace furrow::character
