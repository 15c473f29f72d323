// SPDX-License-Identifier: Apache-2.0
#include "common_shadow_view.glsl"
#include "common_skinning.glsl"

layout(location = 0) in vec3 a_position;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in uvec4 a_joints;
layout(location = 5) in vec4 a_skin_weights;

layout(location = 0) uniform int u_light;

layout(location = 3) out vec2 v_uv;

void main() {
  vec3 position = skinPoint(blendJoints(a_joints, a_skin_weights), a_position);
  v_uv = a_uv;
  gl_Position = shadowPosition(u_lights[u_light], position);
}
