// SPDX-License-Identifier: Apache-2.0

// Averages the noise over 4 x 4 pixels without mixing surfaces of different depth.
//
// SCALE  1 or 2: scene pixels per target pixel, along each axis

layout(binding = 0) uniform sampler2D u_open;
layout(binding = 1) uniform sampler2D u_depth;
layout(location = 0) uniform float u_range;  // largest depth difference that mixes, metres

layout(location = 0) out float f_open;

const float NO_SURFACE = 1e5;  // metres; anything farther is background

// Depth of the scene at a target pixel, metres along the camera's axis.
float depthAt(ivec2 pixel) {
  return texelFetch(u_depth, min(pixel * SCALE, textureSize(u_depth, 0) - 1), 0).r;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_open, 0) - 1;
  float centre = depthAt(pixel);
  float sum = 0.0;
  float weight = 0.0;
  // Groups of pixels without a surface skip the loop.
  int end = centre < NO_SURFACE ? 2 : -2;
  for (int y = -2; y < end; ++y) {
    for (int x = -2; x < 2; ++x) {
      ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
      float w = max(1.0 - abs(depthAt(at) - centre) / u_range, 0.0);
      sum += w * texelFetch(u_open, at, 0).r;
      weight += w;
    }
  }
  f_open = weight > 0.0 ? sum / weight : 1.0;
}
