// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"

// What ambient occlusion leaves of the light of the sky.
//
// SCALE  1 or 2: pixels of the scene to one of the occlusion's, along each axis

// The nearest four values, those of other surfaces left out.
// `range`: metres of depth that still mix.
float openAt(sampler2D open, sampler2D depths, ivec2 pixel, float metres, float range) {
#if SCALE == 1
  return texelFetch(open, pixel, 0).r;
#else
  vec2 place = vec2(pixel) / float(SCALE);
  ivec2 base = ivec2(place);
  vec2 share = fract(place);
  ivec2 last = textureSize(open, 0) - 1;
  ivec2 lastDepth = textureSize(depths, 0) - 1;
  float sum = 0.0;
  float weight = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 at = min(base + corner, last);
    float depth = texelFetch(depths, min(at * SCALE, lastDepth), 0).r;
    vec2 near = mix(1.0 - share, share, vec2(corner));
    float w = near.x * near.y * max(1.0 - abs(depth - metres) / range, 0.0) + 1e-6;
    sum += w * texelFetch(open, at, 0).r;
    weight += w;
  }
  return sum / weight;
#endif
}

// What light that bounces between the sides of a fold gives back, by albedo (Jimenez 2016): folds
// in skin are red, not grey.
vec3 withBounces(float open, vec3 albedo) {
  vec3 a = 2.0404 * albedo - 0.3324;
  vec3 b = -4.7951 * albedo + 0.6417;
  vec3 c = 2.7552 * albedo + 0.6903;
  return max(vec3(open), ((open * a + b) * open + c) * open);
}

// Share of the sky's diffuse light that skin sends back.
vec3 openForDiffuse(float open) {
  const vec3 skin = vec3(0.55, 0.33, 0.25);  // a mean of light skin
  return withBounces(open, skin);
}
