// SPDX-License-Identifier: Apache-2.0
#include "temporal/ycocg.glsl"

// Completes a picture that was drawn with fewer pixels, each time with the scene at a slightly
// different place, from the former pictures of its stream. The method follows Karis 2014 ("High
// Quality Temporal Supersampling") and Salvi 2016 ("An Excursion in Temporal Supersampling").

layout(binding = 0) uniform sampler2D u_picture;  // drawn pixels, display-referred; linear filter
layout(binding = 1) uniform sampler2D u_place;    // the outputs of neighbours.frag.glsl
layout(binding = 2) uniform sampler2D u_mean;
layout(binding = 3) uniform sampler2D u_spread;
layout(binding = 4) uniform sampler2D u_former;   // f_history of the former picture; linear filter
layout(location = 0) uniform vec4 u_drawn;        // xy: drawn pixels per pixel; zw: the jitter,
                                                  // drawn pixels, y down

layout(location = 0) out vec4 f_history;  // rgb: the picture; a: the samples that it is made of
layout(location = 1) out vec4 f_picture;

// How close to a pixel a sample counts: exp(-NEAR d^2), with d in pixels of the picture.
const float NEAR = 2.3;
// At most this many former samples count, and former colours are limited to this many standard
// deviations from the mean of the neighbours: on resting surfaces (x), and on those that move by
// FAST pixels or more (y), where light and detail change with every picture.
const vec2 MOST = vec2(6.0, 0.3);
const vec2 LIMIT = vec2(1.0, 0.5);
const float FAST = 3.0;
const float LEAST_SPREAD = 0.004;  // a grey level of 8 bits

void main() {
  vec2 drawn = gl_FragCoord.xy * u_drawn.xy + u_drawn.zw;
  vec2 drawnSize = vec2(textureSize(u_picture, 0));
  vec2 size = drawnSize / u_drawn.xy;
  ivec2 pixel = clamp(ivec2(drawn), ivec2(0), ivec2(drawnSize) - 1);
  vec4 place = texelFetch(u_place, pixel, 0);
  float speed = min(length(place.xy * size) / FAST, 1.0);

  // Half a texel inside: beyond, the filter would mix in the opposite edge.
  vec2 there = clamp(gl_FragCoord.xy + place.xy * size, vec2(0.5), size - 0.5) / size;
  vec4 former = textureLod(u_former, there, 0.0);
  vec3 mean = texelFetch(u_mean, pixel, 0).rgb;
  vec3 spread = max(texelFetch(u_spread, pixel, 0).rgb, vec3(LEAST_SPREAD));
  vec3 offset = toYcocg(former.rgb) - mean;
  vec3 beyond = abs(offset) / (mix(LIMIT.x, LIMIT.y, speed) * spread);
  float excess = max(max(beyond.x, beyond.y), max(beyond.z, 1.0));
  vec3 kept = fromYcocg(mean + offset / excess);
  // A colour that had to be changed counts less.
  float samples = place.z > 0.0
                      ? min(former.a, mix(MOST.x, MOST.y, speed)) * place.z / excess : 0.0;

  // The sample that is nearest to the pixel. Where there is little else, one pixel would show blocks.
  vec2 inside = clamp(drawn, vec2(0.5), drawnSize - 0.5) / drawnSize;
  vec3 colour = samples > 0.5 ? texelFetch(u_picture, pixel, 0).rgb
                              : textureLod(u_picture, inside, 0.0).rgb;
  vec2 apart = (vec2(pixel) + 0.5 - drawn) / u_drawn.xy;
  float counts = exp(-NEAR * dot(apart, apart));
  vec3 result = mix(kept, colour, counts / (samples + counts));
  f_history = vec4(result, samples + counts);
  f_picture = vec4(result, 1.0);
}
