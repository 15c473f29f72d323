// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/vertex_influence.h"

#include "base/scalar.h"

namespace furrow::wrinkle {

float Lambda(LambdaMode mode, float skin_weight, float smooth_width) {
  switch (mode) {
    // The thesis's form. A weight of 1e-6 already counts fully, which shows as a seam.
    case LambdaMode::kBinary: return skin_weight > 0.0f ? 1.0f : 0.0f;
    case LambdaMode::kSmooth: return Smoothstep(0.0f, smooth_width, skin_weight);
    case LambdaMode::kLinear: return Saturate(skin_weight);
  }
  return 0.0f;
}

float VertexInfluence(std::span<const std::uint16_t> joints, std::span<const float> skin_weights,
                      std::span<const float> influences, int num_masks, int mask, LambdaMode mode,
                      float smooth_width) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::size_t at = std::size_t{joints[i]} * static_cast<std::size_t>(num_masks) +
                           static_cast<std::size_t>(mask);
    sum += Lambda(mode, skin_weights[i], smooth_width) * influences[at];
  }
  return Saturate(sum);
}

}  // namespace furrow::wrinkle
