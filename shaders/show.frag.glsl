// SPDX-License-Identifier: Apache-2.0

// Turns what a pass left in its target into something to look at.
//
// SHOWN  0: the colour as it is, nearest texel; 1: metres as grey, white is near; 2: the red channel
//        as grey; 3: white

layout(binding = 0) uniform sampler2D u_target;
layout(location = 0) uniform vec4 u_look;  // x: pixels of the picture to one texel, y: metres that
                                           // are white, z: metres that are black
layout(location = 0) out vec4 f_colour;

void main() {
  ivec2 last = textureSize(u_target, 0) - 1;
  vec4 texel = texelFetch(u_target, min(ivec2(gl_FragCoord.xy / u_look.x), last), 0);
#if SHOWN == 0
  f_colour = vec4(texel.rgb, 1.0);
#elif SHOWN == 1
  f_colour = vec4(vec3(clamp((u_look.z - texel.r) / (u_look.z - u_look.y), 0.0, 1.0)), 1.0);
#elif SHOWN == 2
  f_colour = vec4(texel.rrr, 1.0);
#else
  f_colour = vec4(1.0);
#endif
}
