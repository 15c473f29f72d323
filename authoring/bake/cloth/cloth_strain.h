// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// How far cloth slips over the body, metres, >= 0.
struct ClothSlip {
  float pressed = 0.0f;  // away from where a bend presses it together, along the compression
  float pulled = 0.0f;   // around a pull
  float fed = 0.0f;      // to where it is pulled
  float feeds = 1.0f;    // how much length a pull gets from around, relative to what it needs, >= 0
  float stretches = 0.0f;  // the share of its length by which cloth stretches before it slips, >= 0
};

// How a pose changes the lengths of the surface below cloth, spread over the cloth.
//
// Skinning bends a limb within a few centimetres of its joint, and compresses the surface there to
// a third of its length and less. Real cloth does not pile up in that hollow: it slips along the
// limb and folds on both sides. So the lost length is spread, mostly along the direction of the
// compression, by about a Gaussian of standard deviation `slip.pressed`. Stretches are spread by
// `slip.pulled`, alike in all directions.
//
// Nor does woven cloth stretch like skin: over the outside of a bend it is hardly longer than it
// was cut, because the garment slips along the limb to feed it. So the cloth within about
// `slip.fed` of a pull loses length, in proportion to how far it is pulled less itself. A pull of
// up to `slip.stretches` counts as none.
//
// `cut`, `posed`: the positions of the mesh's vertices as the cloth was cut and in the pose.
// `room`: one per vertex; vertices with 0 take no part.
struct ClothStrain {
  // One symmetric tensor per vertex, tangent to the surface at rest, in model axes, with
  // eigenvalues >= 0: a line of the surface along the unit vector d loses dot(d, lost d) times its
  // cut length, or gains dot(d, pulled d).
  std::vector<glm::mat3> lost;
  std::vector<glm::mat3> pulled;
  std::vector<float> fed;  // the part of the trace of `lost` that a pull nearby takes
};
[[nodiscard]] ClothStrain MeasureClothStrain(const FineMesh& mesh, std::span<const glm::vec3> cut,
                                             std::span<const glm::vec3> posed,
                                             std::span<const float> room, const ClothSlip& slip);

}  // namespace furrow::authoring
