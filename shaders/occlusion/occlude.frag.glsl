// SPDX-License-Identifier: Apache-2.0
#include "occlusion/openness.glsl"

// Removes the occluded part of the sky's light. The light of lamps is unchanged, because lamps have
// shadows.
//
// SCALE  1 or 2: scene pixels per occlusion pixel, along each axis

layout(binding = 0) uniform sampler2D u_irradiance;
layout(binding = 1) uniform sampler2D u_radiance;  // a: the sky's share
layout(binding = 2) uniform sampler2D u_albedo;    // a: the sky's share of u_irradiance; 0: no skin
layout(binding = 3) uniform sampler2D u_open;
layout(binding = 4) uniform sampler2D u_depth;
layout(location = 0) uniform float u_range;        // largest depth difference that mixes, metres

layout(location = 0) out vec4 f_irradiance;
layout(location = 1) out vec4 f_radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 irradiance = texelFetch(u_irradiance, pixel, 0);
  vec4 radiance = texelFetch(u_radiance, pixel, 0);
  float open = openAt(u_open, u_depth, pixel, texelFetch(u_depth, pixel, 0).r, u_range);
  vec4 albedo = texelFetch(u_albedo, pixel, 0);
  vec3 left = mix(vec3(1.0), openForDiffuse(open), albedo.a);
  vec3 openForRest = albedo.a > 0.0 ? vec3(open) : withBounces(open, albedo.rgb);
  f_irradiance = vec4(irradiance.rgb * left, irradiance.a);
  f_radiance = vec4(radiance.rgb * mix(vec3(1.0), openForRest, radiance.a), radiance.a);
}
