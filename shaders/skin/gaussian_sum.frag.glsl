// SPDX-License-Identifier: Apache-2.0
#include "skin/diffusion.glsl"

// The thesis' scattering: the sum of six increasingly wide blurs of the light on skin, weighted by
// the profile.

layout(binding = 0) uniform sampler2D u_unscattered;
layout(binding = 1) uniform sampler2D u_blur0;
layout(binding = 2) uniform sampler2D u_blur1;
layout(binding = 3) uniform sampler2D u_blur2;
layout(binding = 4) uniform sampler2D u_blur3;
layout(binding = 5) uniform sampler2D u_blur4;
layout(binding = 6) uniform sampler2D u_blur5;
layout(location = 0) uniform float u_strength;  // [0, 1]

layout(location = 0) out vec4 f_irradiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 sum = GAUSSIAN_WEIGHT[0] * texelFetch(u_blur0, pixel, 0).rgb +
             GAUSSIAN_WEIGHT[1] * texelFetch(u_blur1, pixel, 0).rgb +
             GAUSSIAN_WEIGHT[2] * texelFetch(u_blur2, pixel, 0).rgb +
             GAUSSIAN_WEIGHT[3] * texelFetch(u_blur3, pixel, 0).rgb +
             GAUSSIAN_WEIGHT[4] * texelFetch(u_blur4, pixel, 0).rgb +
             GAUSSIAN_WEIGHT[5] * texelFetch(u_blur5, pixel, 0).rgb;
  vec4 unscattered = texelFetch(u_unscattered, pixel, 0);
  f_irradiance = vec4(mix(unscattered.rgb, sum, u_strength), unscattered.a);
}
