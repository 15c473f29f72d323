// SPDX-License-Identifier: Apache-2.0

// Turns what a pass left in its target into something to look at.
//
// SHOWN  0: the colour as it is, nearest texel; 1: metres as grey, white is near; 2: the red channel
//        as grey; 3: white; 4: depths of [0, 1] as grey, white is near, in the middle of the picture

layout(binding = 0) uniform sampler2D u_target;
layout(location = 0) uniform vec4 u_look;  // x: pixels of the picture to one texel, y: metres that
                                           // are white, z: metres that are black, w: pixels of the
                                           // picture from its bottom to its top
layout(location = 0) out vec4 f_colour;

void main() {
  ivec2 last = textureSize(u_target, 0) - 1;
  vec2 pixel = gl_FragCoord.xy;
#if SHOWN == 4
  pixel.y -= 0.5 * (u_look.w - u_look.x * float(last.y + 1));
  if (pixel.y < 0.0 || pixel.y >= u_look.x * float(last.y + 1)) {
    f_colour = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
#endif
  vec4 texel = texelFetch(u_target, min(ivec2(pixel / u_look.x), last), 0);
#if SHOWN == 0
  f_colour = vec4(texel.rgb, 1.0);
#elif SHOWN == 1
  f_colour = vec4(vec3(clamp((u_look.z - texel.r) / (u_look.z - u_look.y), 0.0, 1.0)), 1.0);
#elif SHOWN == 4
  f_colour = vec4(vec3(1.0 - texel.r), 1.0);
#elif SHOWN == 2
  f_colour = vec4(texel.rrr, 1.0);
#else
  f_colour = vec4(1.0);
#endif
}
