// SPDX-License-Identifier: Apache-2.0
#include "common_math.glsl"

// Takes from the light of the sky what ambient occlusion leaves none of. Lamps have shadows.
//
// SCALE  1 or 2: pixels of the scene to one of the occlusion's, along each axis

layout(binding = 0) uniform sampler2D u_irradiance;
layout(binding = 1) uniform sampler2D u_radiance;  // a: the sky's share
layout(binding = 2) uniform sampler2D u_albedo;    // a: the sky's share of u_irradiance
layout(binding = 3) uniform sampler2D u_open;
layout(binding = 4) uniform sampler2D u_depth;
layout(location = 0) uniform float u_range;        // metres of depth that still mix

layout(location = 0) out vec4 f_irradiance;
layout(location = 1) out vec4 f_radiance;

// The nearest four values, those of other surfaces left out.
float openAt(ivec2 pixel, float metres) {
#if SCALE == 1
  return texelFetch(u_open, pixel, 0).r;
#else
  vec2 place = vec2(pixel) / float(SCALE);
  ivec2 base = ivec2(place);
  vec2 share = fract(place);
  ivec2 last = textureSize(u_open, 0) - 1;
  ivec2 lastDepth = textureSize(u_depth, 0) - 1;
  float sum = 0.0;
  float weight = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 at = min(base + corner, last);
    float depth = texelFetch(u_depth, min(at * SCALE, lastDepth), 0).r;
    vec2 near = mix(1.0 - share, share, vec2(corner));
    float w = near.x * near.y * max(1.0 - abs(depth - metres) / u_range, 0.0) + 1e-6;
    sum += w * texelFetch(u_open, at, 0).r;
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

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 irradiance = texelFetch(u_irradiance, pixel, 0);
  vec4 radiance = texelFetch(u_radiance, pixel, 0);
  float open = openAt(pixel, texelFetch(u_depth, pixel, 0).r);
  const vec3 skin = vec3(0.55, 0.33, 0.25);  // a mean of light skin
  vec3 left = mix(vec3(1.0), withBounces(open, skin), texelFetch(u_albedo, pixel, 0).a);
  f_irradiance = vec4(irradiance.rgb * left, irradiance.a);
  f_radiance = vec4(radiance.rgb * (1.0 - radiance.a * (1.0 - open)), radiance.a);
}
