// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/drivers/hinge/hinge_driver.h"

namespace furrow::wrinkle {

// Thesis 4.6 without SIMD, for comparison with the solver.

// How far a joint is bent, in [0, 1], from the cosine between its two bones, both pointing away
// from the trunk. Straight (1) gives 0; fully flexed (cos(180 - beta)) gives 1.
[[nodiscard]] float Bend(float cosine, float bend_scale);

// 4.6 with a sign: Bend() if `lower` has turned right-handed about `axis` away from `upper`, and 0
// if it has turned the other way (hyperextension).
//
// - `upper`, `lower`, `axis` unit vectors of one space, `axis` across `upper`.
// - Sideways bending fades out from 60 to 90 degrees off the axis, so the value is continuous. It
//   only jumps where the bones fold onto each other exactly (180 degrees).
[[nodiscard]] float SignedBend(const glm::vec3& upper, const glm::vec3& lower,
                               const glm::vec3& axis, float bend_scale);

}  // namespace furrow::wrinkle
