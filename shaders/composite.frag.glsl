// SPDX-License-Identifier: Apache-2.0
#include "common_tonemap.glsl"

// SAMPLES   of the scene's target, at least 1
// TONEMAP   1: exposure, tone map and sRGB curve, after the samples were averaged in linear light;
//           0: the values are data (normals, masks) and stay as they are

layout(binding = 0) uniform sampler2DMS u_scene;   // linear
layout(location = 0) uniform float u_exposure;     // > 0
layout(location = 1) uniform int u_height;         // pixels

layout(location = 0) out vec4 f_colour;            // display-referred

vec3 displayColour(vec3 colour) {
#if TONEMAP
  return linearToSrgb(tonemapNeutral(colour * u_exposure));
#else
  return colour;
#endif
}

void main() {
  // Upside down: the rows of a picture start at the top, those of a read-back at the bottom.
  ivec2 pixel = ivec2(gl_FragCoord.x, u_height - 1 - int(gl_FragCoord.y));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < SAMPLES; ++i) sum += texelFetch(u_scene, pixel, i).rgb;
  f_colour = vec4(displayColour(sum / float(SAMPLES)), 1.0);
}
