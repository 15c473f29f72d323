// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "character/mesh/mesh.h"

namespace furrow::render {

// How the skin weights of a vertex change along the surface, per metre: the k-th component belongs
// to the vertex's k-th joint. Influences without weight have 0.
struct WeightGradient {
  glm::vec4 along{0.0f};   // along the tangent, made perpendicular to the normal
  glm::vec4 across{0.0f};  // along cross(normal, tangent)
};

// The gradients of a mesh's skin weights, one per vertex; empty if all are 0, as on rigid parts.
//
// A joint turns the normals of its vertices. Where its weight changes over the surface, its motion
// also bends the surface: a cheek that moves forward becomes round, and a lid that closes unfolds.
// The gradients give the tangents of the moved surface, and with them its normals (Tarini, Panozzo
// and Sorkine-Hornung 2014, "Accurate and Efficient Lighting for Skinned Models").
// scene/pose.vert.glsl has the formula.
//
// The gradient is the least-squares fit to the neighbours in the triangles, by their distance on
// the surface. Vertices that character::WeldVertices() merges have the same neighbours, so that UV
// seams stay invisible.
[[nodiscard]] std::vector<WeightGradient> WeightGradients(const character::Mesh& mesh);

}  // namespace furrow::render
