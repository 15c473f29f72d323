// SPDX-License-Identifier: Apache-2.0
#include "skin/scatter.glsl"
#include "common/texel.glsl"

// One of the two passes of the separable kernel (after Jimenez et al. 2015): along x, then along y.
//
// - Offsets and weights come from render/skin/pixel_kernel.h and apply at the focus distance. The
//   shader scales the offsets to the pixel's own distance. Pixels are square, so both axes use the
//   same offsets. Taps lie slightly beside the axis, so that each pass smooths the steps of the
//   other.
// - Taps outside the skin, and taps at a depth that light does not reach, are dropped, and the
//   weights of the others are normalised. Light does not leak, and uniform light stays uniform.

const int MAX_TAPS = 21;  // on one side, including the centre

layout(binding = 0) uniform sampler2D u_irradiance;  // a: metres behind the focus
layout(binding = 1) uniform sampler2D u_unscattered;

layout(location = 0) uniform ivec2 u_axis;
layout(location = 1) uniform int u_num_taps;          // on one side, without the centre
layout(location = 2) uniform vec3 u_geometry;         // x: focus distance (m), y: 1 / depth range
                                                      // (1/m), z: gradient
layout(location = 3) uniform float u_strength;        // of the whole kernel, in the second pass; 1
                                                      // in the first
layout(location = 4) uniform vec2 u_offset[MAX_TAPS];  // pixels; [0]: the centre
layout(location = 25) uniform vec3 u_weight[MAX_TAPS];

layout(location = 0) out vec4 f_irradiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 centre = texelFetch(u_irradiance, pixel, 0);
  bool skin = isSkin(centre);
  float metres = u_geometry.x + centre.a;
  // Depth difference per pixel along the axis, on the side without an edge.
  float before = texelInside(u_irradiance, pixel - u_axis).a;
  float after = texelInside(u_irradiance, pixel + u_axis).a;
  float slope = min(abs(centre.a - before), abs(after - centre.a));
  // Thesis 4.7: s = alpha / (d + beta |grad d|), with the gradient over the kernel's reach in
  // pixels.
  float reach = dot(u_offset[u_num_taps], vec2(u_axis));
  float scale = u_geometry.x / (metres + u_geometry.z * min(slope, 0.1) * reach);
  vec3 sum = u_weight[0] * centre.rgb;
  vec3 weight = u_weight[0];
  // Groups of pixels without skin skip the loop.
  int taps = skin ? u_num_taps : 0;
  for (int i = 1; i <= taps; ++i) {
    ivec2 offset = ivec2(floor(u_offset[i] * scale + 0.5));
    for (int side = 0; side < 2; ++side) {
      vec4 light = texelInside(u_irradiance, side == 0 ? pixel + offset : pixel - offset);
      float apart = (light.a - centre.a) * u_geometry.y;
      vec3 w = u_weight[i] * max(1.0 - apart * apart, 0.0);
      sum += w * light.rgb;
      weight += w;
    }
  }
  vec3 scattered = sum / weight;
  vec3 unscattered = texelFetch(u_unscattered, pixel, 0).rgb;
  vec3 light = skin ? mix(unscattered, scattered, u_strength) : vec3(0.0);
  f_irradiance = vec4(light, centre.a);
}
