// SPDX-License-Identifier: Apache-2.0
#include "wrinkles/wrinkles.glsl"

layout(binding = 2) uniform sampler2DArray u_masks;                // RGBA, one region per channel

#if CROWD
// The rows of u_mask_weights for every subject, one subject after another.
layout(binding = 13) uniform samplerBuffer u_subject_weights;
uint currentSubject = 0u;  // set at the start of main()

// The weights of one mask layer's four regions for one active map: row = slot * MASK_LAYERS +
// layer.
vec4 maskWeights(int row) {
  int length = 4 * MAP_SLOTS * MASK_LAYERS;
  return texelFetch(u_subject_weights, int(currentSubject) * length + row);
}
#else
vec4 maskWeights(int row) { return u_mask_weights[row]; }
#endif

// Coefficient of one active map at this place: the sum of weight * mask over the regions with
// painted masks, plus the dynamic mask, clamped to [0, 1]. At least 0; above 1 only where masks
// overlap. `dynamicMasks`: interpolated sums of the vertices. They are clamped here and not per
// vertex, so that within a triangle they stay a sum over joints, which can be composed in advance
// (render/compose/skinned_masks.h).
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
