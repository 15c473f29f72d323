// SPDX-License-Identifier: Apache-2.0
#include "common_frame.glsl"
#include "common_skinning.glsl"

layout(location = 0) in vec3 a_position;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in uvec4 a_joints;
layout(location = 5) in vec4 a_skin_weights;

layout(location = 0) uniform int u_light;

layout(location = 3) out vec2 v_uv;

// Depth is linear in metres for perspective lamps as well: z is multiplied by the w that will
// divide it. It is exact at the vertices, and triangles are small.
void main() {
  vec3 position = skinPoint(blendJoints(a_joints, a_skin_weights), a_position);
  Light light = u_lights[u_light];
  vec3 p = (light.shadow_view * vec4(position, 1.0)).xyz;
  float w = light.shadow.w > 0.5 ? -p.z : 1.0;
  float depth = (-p.z - light.shadow.y) * light.shadow.z;
  v_uv = a_uv;
  gl_Position = vec4(p.xy * light.shadow.x, (depth * 2.0 - 1.0) * w, w);
}
