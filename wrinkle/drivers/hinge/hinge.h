// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// A hinge's axis or a ball's forward within 6 degrees of the bone is refused: it turns the bone
// about itself. Sine of that angle.
inline constexpr float kLeastAcross = 0.1f;
inline constexpr float kLeastSine = 1e-6f;     // bones closer to parallel have no plane
inline constexpr float kFullAlongAxis = 0.5f;  // cosine to the axis from which a bend counts whole

// 1 / (1 + cos(beta)) of thesis 4.6, `beta_degrees` being the angle between the bones when fully
// flexed. 0 at beta = 180, where straight and fully flexed are one and no bend can be told.
[[nodiscard]] float BendScale(float beta_degrees);

// Thesis 4.6: how far a joint is bent, in [0, 1], from the cosine between its two bones, both
// pointing away from the trunk: straight (1) gives 0, fully flexed (cos(180 - beta)) gives 1.
[[nodiscard]] float Bend(float cosine, float bend_scale);

// 4.6 with a sign: Bend() where `lower` has turned right-handed about `axis` away from `upper`, 0
// where it has turned the other way (hyperextension).
//
// - `upper`, `lower`, `axis` unit vectors of one space, `axis` across `upper`.
// - Bending sideways counts less and less from 60 to 90 degrees off the axis, so that the value is
//   continuous; it jumps only where the bones fold onto each other exactly (180 degrees).
[[nodiscard]] float SignedBend(const glm::vec3& upper, const glm::vec3& lower,
                               const glm::vec3& axis, float bend_scale);

}  // namespace furrow::wrinkle
