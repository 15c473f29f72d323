// SPDX-License-Identifier: Apache-2.0
#include "common/texel.glsl"

// Bloom: keeps light above a threshold at a quarter of the picture's width and height, then blurs
// it along x and along y.
//
// BRIGHT  1: extract bright light and shrink it; 0: one of the two blurs

layout(binding = 0) uniform sampler2D u_light;
layout(location = 0) uniform vec4 u_look;  // BRIGHT: x: threshold, y: exposure; else x, y: the
                                           // axis, z: standard deviation in pixels
layout(location = 0) out vec4 f_light;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
#if BRIGHT
  for (int i = 0; i < 16; ++i) {
    vec3 light = u_look.y * texelInside(u_light, 4 * pixel + ivec2(i & 3, i >> 2)).rgb;
    // Scales the light by how far its strongest channel exceeds the threshold, which keeps the
    // colour.
    float peak = max(max(light.r, light.g), max(light.b, 1e-6));
    sum += light * (max(peak - u_look.x, 0.0) / peak);
  }
  sum /= 16.0;
#else
  ivec2 axis = ivec2(u_look.xy);
  int reach = int(ceil(3.0 * u_look.z));
  float whole = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    float w = exp(-0.5 * float(i * i) / (u_look.z * u_look.z));
    sum += w * texelInside(u_light, pixel + i * axis).rgb;
    whole += w;
  }
  sum /= whole;
#endif
  f_light = vec4(sum, 1.0);
}
