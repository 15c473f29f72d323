// SPDX-License-Identifier: Apache-2.0
#include "post/tonemap.glsl"

// Converts linear light, colours or data to the 8-bit picture.
//
// SAMPLES   samples per pixel of u_shown, at least 1, averaged in linear light
// SHOW      0: data in [0, 1], unchanged; 1: colour in [0, 1], gets the sRGB curve; 2: light, gets
//           exposure, tone map and the sRGB curve
// BLOOM     1: add bloom
// TONE_MAP  0: Khronos PBR Neutral, 1: clip at 1
// BOTTOM_UP 1: the picture's rows start at the bottom, as on a screen; 0: at the top

#if SAMPLES > 1
layout(binding = 0) uniform sampler2DMS u_shown;   // linear
#else
layout(binding = 0) uniform sampler2D u_shown;
#endif
layout(location = 0) uniform float u_exposure;     // > 0
#if !BOTTOM_UP
layout(location = 1) uniform int u_height;         // pixels
#endif

#if BLOOM
layout(binding = 1) uniform sampler2D u_bloom;     // linear, exposed, smaller than the picture
layout(location = 2) uniform float u_bloom_strength;
#endif

layout(location = 0) out vec4 f_colour;            // rgb: display-referred, a: its luma

// The display-referred colour, [0, 1], of a linear `colour` at `place` (UV).
vec3 displayColour(vec3 colour, vec2 place) {
#if SHOW == 2
  colour *= u_exposure;
#if BLOOM
  vec2 half_texel = 0.5 / vec2(textureSize(u_bloom, 0));
  colour += u_bloom_strength * textureLod(u_bloom, clamp(place, half_texel, 1.0 - half_texel), 0.0).rgb;
#endif
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
#if BOTTOM_UP
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#else
  // Flips the picture: its rows start at the top, but a read-back starts at the bottom.
  ivec2 pixel = ivec2(gl_FragCoord.x, u_height - 1 - int(gl_FragCoord.y));
#endif
  vec3 sum = vec3(0.0);
  for (int i = 0; i < SAMPLES; ++i) sum += texelFetch(u_shown, pixel, i).rgb;
#if SAMPLES > 1
  vec2 place = (vec2(pixel) + 0.5) / vec2(textureSize(u_shown));
#else
  vec2 place = (vec2(pixel) + 0.5) / vec2(textureSize(u_shown, 0));
#endif
  vec3 colour = displayColour(sum / float(SAMPLES), place);
  f_colour = vec4(colour, dot(colour, vec3(0.299, 0.587, 0.114)));
}
