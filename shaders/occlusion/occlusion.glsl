// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"
#include "common/view.glsl"

// Shared by both methods of ambient occlusion. A pixel of the target covers SCALE x SCALE pixels of
// the scene.
//
// SCALE    1 or 2
// SAMPLES  samples per pixel, at least 4

layout(binding = 0) uniform sampler2D u_depth;   // metres along the camera's axis
layout(binding = 1) uniform sampler2D u_normal;  // unit, model space
layout(location = 4) uniform vec2 u_reach;       // x: radius (metres), y: strength

layout(location = 0) out float f_open;           // 1: the whole sky is visible

// The scene pixel of this target pixel.
ivec2 scenePixel() {
  ivec2 last = textureSize(u_depth, 0) - 1;
  return min(ivec2(gl_FragCoord.xy) * SCALE, last);
}

// Depth of the scene at a pixel, clamped to the border; metres along the camera's axis.
float depthAt(vec2 pixel) {
  return texelFetch(u_depth, clamp(ivec2(pixel), ivec2(0), textureSize(u_depth, 0) - 1), 0).r;
}

// Unit normal of the scene at a pixel, view space; 0 on the background.
vec3 viewNormal(ivec2 pixel) {
  return normalizeOrZero(u_view_rotation * (texelFetch(u_normal, pixel, 0).xyz));
}

// A number in [0, 1) that differs for all pixels of a 4 x 4 tile. The blur averages the resulting
// noise.
float tileNoise() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  return (float((p.x + p.y) & 3) * 4.0 + float(p.x)) / 16.0;
}
