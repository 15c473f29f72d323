// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::motion {

// A joint that rests `offset` from its parent, unturned.
inline wrinkle::JointDesc OffsetJoint(const char* name, int parent, const glm::vec3& offset) {
  return {.name = name, .parent = parent, .rest = {.translation = offset}, .tail = {}};
}

}  // namespace furrow::motion
