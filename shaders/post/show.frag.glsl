// SPDX-License-Identifier: Apache-2.0

// Makes the target of a pass visible.
//
// SHOWN  0: colour, unchanged, nearest texel; 1: metres as grey, near is white; 2: the red channel as
//        grey; 3: white; 4: depths in [0, 1] as grey, near is white, centred vertically

layout(binding = 0) uniform sampler2D u_target;
layout(location = 0) uniform vec4 u_look;  // x: picture pixels per texel, y: metres that are white,
                                           // z: metres that are black, w: height of the picture in
                                           // pixels
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
