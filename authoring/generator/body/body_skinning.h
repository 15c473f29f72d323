// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

// Skin weights of the body. Places are in the modelling pose (see BodyShape).
namespace furrow::authoring {

// Of the shirt's trunk, which hands over to the arms round the armholes.
[[nodiscard]] Influences TorsoInfluences(const BodyShape& shape, const glm::vec3& place);

// Of a sleeve (`side` +1: left), whose edge at the armhole has the influences `hole`; `from_hole`:
// how far down the sleeve, metres.
[[nodiscard]] Influences SleeveInfluences(const BodyShape& shape, float side,
                                          const glm::vec3& place, const Influences& hole,
                                          float from_hole);

[[nodiscard]] Influences TrouserInfluences(const BodyShape& shape, const glm::vec3& place);

// Of a shoe: the foot, and the toes from the ball on.
[[nodiscard]] Influences ShoeInfluences(const BodyShape& shape, const glm::vec3& place);

// All of one joint.
[[nodiscard]] Influences InfluenceOf(const wrinkle::Skeleton& skeleton, const std::string& joint);

// Carries every point from the modelling pose to rest by its influences.
void CarryToRest(const BodyShape& shape, QuadNet* net);

}  // namespace furrow::authoring
