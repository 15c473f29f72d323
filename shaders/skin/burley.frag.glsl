// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"
#include "skin/scatter.glsl"
#include "common/texel.glsl"

// Burley's normalised diffusion with one disc of taps (BurleyDisc() of
// render/skin/subsurface_kernel.h), rotated by a different angle at every pixel.

const int MAX_TAPS = 64;

layout(binding = 0) uniform sampler2D u_irradiance;  // a: metres behind the focus
layout(location = 0) uniform int u_num_taps;
layout(location = 1) uniform vec4 u_geometry;  // x: focus distance (m), y: 1 / depth range (1/m),
                                               // z: pixels per mm at the focus, w: strength
layout(location = 2) uniform vec2 u_offset[MAX_TAPS];  // mm
layout(location = 66) uniform vec3 u_weight[MAX_TAPS];

layout(location = 0) out vec4 f_irradiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 centre = texelFetch(u_irradiance, pixel, 0);
  bool skin = isSkin(centre);
  float scale = u_geometry.z * u_geometry.x / (u_geometry.x + centre.a);
  // Measured from the picture's centre, so that the noise does not depend on the picture's size.
  vec2 place = vec2(pixel - textureSize(u_irradiance, 0) / 2);
  float noise = fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
  float c = cos(2.0 * PI * noise);
  float s = sin(2.0 * PI * noise);
  mat2 turn = mat2(c, s, -s, c);
  vec3 sum = u_weight[0] * centre.rgb;
  vec3 weight = u_weight[0];
  int taps = skin ? u_num_taps : 0;
  for (int i = 1; i < taps; ++i) {
    ivec2 offset = ivec2(floor(scale * (turn * u_offset[i]) + 0.5));
    vec4 light = texelInside(u_irradiance, pixel + offset);
    float apart = (light.a - centre.a) * u_geometry.y;
    vec3 w = u_weight[i] * max(1.0 - apart * apart, 0.0);
    sum += w * light.rgb;
    weight += w;
  }
  f_irradiance = vec4(skin ? mix(centre.rgb, sum / weight, u_geometry.w) : vec3(0.0), centre.a);
}
