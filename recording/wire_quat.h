// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "protocol/messages/messages.h"

namespace furrow::recording {

// A rotation of the wire as a unit quaternion. The wire allows lengths within 1e-3 of 1; the solver
// needs unit quaternions. One that is of unit length to float precision passes unchanged, since
// normalizing it again would change its last bits, and with them the weights. The daemon and the
// reader of takes share this function, so that both give the same weights for a take.
[[nodiscard]] inline glm::quat ToUnitQuat(const protocol::Quat& q) {
  constexpr float kUnit = 1e-6f;
  const glm::quat rotation(q.w, q.x, q.y, q.z);
  return std::abs(glm::dot(rotation, rotation) - 1.0f) <= kUnit ? rotation
                                                                : glm::normalize(rotation);
}

}  // namespace furrow::recording
