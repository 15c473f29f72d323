// SPDX-License-Identifier: Apache-2.0
#include "wrinkles/wrinkles.glsl"

layout(binding = 2) uniform sampler2DArray u_masks;                // RGBA, one region a channel

#if CROWD
// The same rows of every subject, one after the other.
layout(binding = 13) uniform samplerBuffer u_subject_weights;
uint currentSubject = 0u;  // set first in main

vec4 maskWeights(int row) {
  int length = 4 * MAP_SLOTS * MASK_LAYERS;
  return texelFetch(u_subject_weights, int(currentSubject) * length + row);
}
#else
vec4 maskWeights(int row) { return u_mask_weights[row]; }
#endif

// What the masks make of one active map here: the sum of the texture-masked regions' weight * mask,
// plus the dynamic mask, [0, 1]. Not below 0; above 1 only where masks overlap. `dynamicMasks`:
// sums that vertices bring. They are clamped here, so that within a triangle they stay a sum over
// joints, which can be composed beforehand (render/compose/skinned_masks.h).
float wrinkleCoefficient(int slot, vec4 masks[MASK_LAYERS], vec4 dynamicMasks[MAP_SLOTS]) {
  float sum = 0.0;
#if WRINKLE_TEXTURE
  for (int layer = 0; layer < MASK_LAYERS; ++layer) {
    sum += dot(maskWeights(slot * MASK_LAYERS + layer), masks[layer]);
  }
#endif
#if WRINKLE_DYNAMIC
  sum += min(dynamicMasks[slot >> 2][slot & 3], 1.0);
#endif
  return sum;
}
