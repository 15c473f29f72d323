// SPDX-License-Identifier: Apache-2.0
#include "common_wrinkles.glsl"

// How much of a joint's influence a vertex takes, by its skin weight in [0, 1]. Thesis 4.2; the
// smooth form has no seam where a skin weight fades out.
float lambdaOf(ActiveMap map, float skinWeight) {
  if (map.lambda == 1) return skinWeight > 0.0 ? 1.0 : 0.0;
  if (map.lambda == 2) return skinWeight;
  return smoothstep(0.0, max(map.smoothWidth, 1e-6), skinWeight);
}

// Thesis 4.2: clamp(sum over the vertex's joints of lambda(skin weight) * influence, 0, 1).
float dynamicMask(ActiveMap map, uvec4 joints, vec4 skinWeights) {
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    float influence = u_joint_influences[joints[i] * uint(u_map_count) + uint(map.map)];
    sum += lambdaOf(map, skinWeights[i]) * influence;
  }
  return clamp(sum, 0.0, 1.0);
}
