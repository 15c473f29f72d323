// SPDX-License-Identifier: Apache-2.0
#include "common_tonemap.glsl"

// SAMPLES   of what is shown, at least 1; they are averaged in linear light
// SHOW      0: data in [0, 1], stays as it is; 1: a colour in [0, 1], gets sRGB's curve; 2: light,
//           gets exposure and tone map as well
// TONE_MAP  0: Khronos PBR Neutral, 1: cut at 1

#if SAMPLES > 1
layout(binding = 0) uniform sampler2DMS u_shown;   // linear
#else
layout(binding = 0) uniform sampler2D u_shown;
#endif
layout(location = 0) uniform float u_exposure;     // > 0
layout(location = 1) uniform int u_height;         // pixels

layout(location = 0) out vec4 f_colour;            // display-referred

vec3 displayColour(vec3 colour) {
#if SHOW == 2
  colour *= u_exposure;
#if TONE_MAP == 0
  colour = tonemapNeutral(colour);
#endif
#endif
#if SHOW >= 1
  colour = linearToSrgb(clamp(colour, 0.0, 1.0));
#endif
  return colour;
}

void main() {
  // Upside down: the rows of a picture start at the top, those of a read-back at the bottom.
  ivec2 pixel = ivec2(gl_FragCoord.x, u_height - 1 - int(gl_FragCoord.y));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < SAMPLES; ++i) sum += texelFetch(u_shown, pixel, i).rgb;
  f_colour = vec4(displayColour(sum / float(SAMPLES)), 1.0);
}
