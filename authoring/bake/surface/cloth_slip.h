// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// How much length cloth gains because a bend pushes cloth along the body.
//
// Skinning bends a limb within a few centimetres of its joint, and compresses the surface there to
// a third of its length and less. Real cloth does not pile up in that hollow: it slips along the
// limb and folds on both sides. So the lost length is spread, mostly along the direction of the
// compression, by about a Gaussian of standard deviation `reach` (metres, >= 0). Each place gains
// what reaches it beyond its own loss. The hollow keeps its own folds.
//
// `cut`, `posed`: the positions of the mesh's vertices as the cloth was cut and in the pose.
// `room`: one per vertex; vertices with 0 take no part.
//
// Returns one symmetric tensor per vertex, tangent to the surface at rest, in model axes: a line of
// cloth along the unit vector d gains dot(d, G d) times its cut length.
[[nodiscard]] std::vector<glm::mat3> SlippedLength(const FineMesh& mesh,
                                                   std::span<const glm::vec3> cut,
                                                   std::span<const glm::vec3> posed,
                                                   std::span<const float> room, float reach);

}  // namespace furrow::authoring
