// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

// Skin weights of the body's clothes. Every `place` is a point in model space, metres, in the
// modelling pose, in which the arms hang 30 degrees away from the sides.
namespace furrow::authoring {

// The weights of the shirt's trunk, which blends into the arms around the armholes.
[[nodiscard]] Influences TorsoInfluences(const BodyShape& shape, const glm::vec3& place);

// The weights of a sleeve. `side`: +1 left, -1 right; `hole`: the influences at the sleeve's
// armhole edge; `from_hole`: distance from that edge, metres.
[[nodiscard]] Influences SleeveInfluences(const BodyShape& shape, float side,
                                          const glm::vec3& place, const Influences& hole,
                                          float from_hole);

// The weights of the trousers: hips, upper and lower legs.
[[nodiscard]] Influences TrouserInfluences(const BodyShape& shape, const glm::vec3& place);

// The weights of a shoe, which follows the foot joint up to the ball of the foot and the toes joint
// from there on.
[[nodiscard]] Influences ShoeInfluences(const BodyShape& shape, const glm::vec3& place);

// A weight of 1 on the joint named `joint`, which must exist.
[[nodiscard]] Influences InfluenceOf(const wrinkle::Skeleton& skeleton, const std::string& joint);

// Moves every point of `net` from the modelling pose to the rest pose (T-pose), by its influences.
void CarryToRest(const BodyShape& shape, QuadNet* net);

}  // namespace furrow::authoring
