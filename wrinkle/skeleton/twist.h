// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// Below this sum of squares of sine and cosine there is no twist to tell from the swing.
inline constexpr float kLeastTwistSquare = 1e-10f;

// The twist of a swing-twist decomposition: by how many radians, in [-pi, pi], unit quaternion
// `rotation` turns right-handed about unit vector `axis`, the rest of it being a swing that moves
// the axis. `rotation` and its negative give the same angle.
//
// Undefined where the swing is a half turn: 0 there. Jumps between pi and -pi at a half twist.
[[nodiscard]] float TwistAngle(const glm::quat& rotation, const glm::vec3& axis);

}  // namespace furrow::wrinkle
