// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"

// Where a lamp sees a point of model space. Depth is linear in metres for perspective lamps as
// well: z is multiplied by the w that will divide it. It is exact at the vertices, and triangles are
// small.
vec4 shadowPosition(Light light, vec3 position) {
  vec3 p = (light.shadow_view * vec4(position, 1.0)).xyz;
  float w = light.shadow.w > 0.5 ? -p.z : 1.0;
  float depth = (-p.z - light.shadow.y) * light.shadow.z;
  return vec4(p.xy * light.shadow.x, (depth * 2.0 - 1.0) * w, w);
}
