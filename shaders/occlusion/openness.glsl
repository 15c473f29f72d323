// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"

// How much of the sky's light ambient occlusion leaves.
//
// SCALE  1 or 2: scene pixels per occlusion pixel, along each axis

// Openness at a scene pixel of depth `metres`, [0, 1]: bilinear over the nearest four values,
// without those of other surfaces. `range`: largest depth difference that mixes, metres.
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

// Openness, [0, 1] per channel, including the light that bounces between the sides of a fold, by
// albedo (Jimenez, Wu, Pesce and Jarabo 2016). It makes folds in skin red and not grey.
vec3 withBounces(float open, vec3 albedo) {
  vec3 a = 2.0404 * albedo - 0.3324;
  vec3 b = -4.7951 * albedo + 0.6417;
  vec3 c = 2.7552 * albedo + 0.6903;
  return max(vec3(open), ((open * a + b) * open + c) * open);
}

// Share of the sky's diffuse light that skin reflects, [0, 1] per channel.
vec3 openForDiffuse(float open) {
  const vec3 skin = vec3(0.55, 0.33, 0.25);  // mean albedo of light skin
  return withBounces(open, skin);
}
