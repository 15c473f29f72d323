// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"

// Clip-space position of a model-space point as a lamp sees it. Depth is linear in metres for
// perspective lamps too: z is premultiplied by the w that it will be divided by. This is exact at
// vertices, and triangles are small.
vec4 shadowPosition(Light light, vec3 position) {
  vec3 p = (light.shadow_view * vec4(position, 1.0)).xyz;
  float w = light.shadow.w > 0.5 ? -p.z : 1.0;
  float depth = (-p.z - light.shadow.y) * light.shadow.z;
  return vec4(p.xy * light.shadow.x, (depth * 2.0 - 1.0) * w, w);
}
