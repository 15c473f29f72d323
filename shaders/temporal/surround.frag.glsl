// SPDX-License-Identifier: Apache-2.0

// The even background around the subject, which needs no former picture. The outputs are those of
// accumulate.frag.glsl.

layout(binding = 0) uniform sampler2D u_picture;
layout(location = 0) uniform vec4 u_drawn;  // xy: drawn pixels per pixel

layout(location = 0) out vec4 f_history;
layout(location = 1) out vec4 f_picture;

void main() {
  vec3 colour = texelFetch(u_picture, ivec2(gl_FragCoord.xy * u_drawn.xy), 0).rgb;
  f_history = vec4(colour, 1.0);
  f_picture = vec4(colour, 1.0);
}
