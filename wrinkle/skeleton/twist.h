// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// If sine^2 + cosine^2 is below this value, twist and swing cannot be separated.
inline constexpr float kLeastTwistSquare = 1e-10f;

// The twist of a swing-twist decomposition: the angle in radians, in [-pi, pi], by which the unit
// quaternion `rotation` turns right-handed about the unit vector `axis`. The rest of the rotation
// is a swing that moves the axis. `rotation` and its negative give the same angle.
//
// A swing of half a turn has no defined twist; the result is then 0. The angle jumps between pi and
// -pi at half a turn of twist.
[[nodiscard]] float TwistAngle(const glm::quat& rotation, const glm::vec3& axis);

}  // namespace furrow::wrinkle
