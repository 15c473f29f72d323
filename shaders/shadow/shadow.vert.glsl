// SPDX-License-Identifier: Apache-2.0
#include "shadow/shadow_view.glsl"

// A vertex as scene/pose.vert.glsl wrote it.
layout(location = 0) in vec3 a_position;
layout(location = 3) in vec2 a_uv;

layout(location = 0) uniform int u_light;

layout(location = 3) out vec2 v_uv;

void main() {
  v_uv = a_uv;
  gl_Position = shadowPosition(u_lights[u_light], a_position);
}
