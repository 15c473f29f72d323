// SPDX-License-Identifier: Apache-2.0

// Adds the scattered light, times albedo, to the light that did not scatter. Linear radiance.

layout(binding = 0) uniform sampler2D u_scattered;
layout(binding = 1) uniform sampler2D u_radiance;
layout(binding = 2) uniform sampler2D u_albedo;

layout(location = 0) out vec4 f_colour;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 scattered = texelFetch(u_scattered, pixel, 0).rgb * texelFetch(u_albedo, pixel, 0).rgb;
  f_colour = vec4(scattered + texelFetch(u_radiance, pixel, 0).rgb, 1.0);
}
