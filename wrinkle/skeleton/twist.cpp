// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/twist.h"

#include <cmath>

namespace furrow::wrinkle {

float TwistAngle(const glm::quat& rotation, const glm::vec3& axis) {
  // The twist part of the swing-twist decomposition: project the vector part onto the axis. The
  // angle is undefined for a half turn about an axis across.
  float sine = rotation.x * axis.x + rotation.y * axis.y + rotation.z * axis.z;
  float cosine = rotation.w;
  if (!(sine * sine + cosine * cosine > kLeastTwistSquare)) return 0.0f;
  if (cosine < 0.0f) {
    sine = -sine;
    cosine = -cosine;
  }
  return 2.0f * std::atan2(sine, cosine);
}

}  // namespace furrow::wrinkle
