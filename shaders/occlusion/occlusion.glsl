// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"
#include "common/view.glsl"

// What both methods of ambient occlusion share: one value a pixel of the target, of which each
// stands for SCALE x SCALE pixels of the scene.
//
// SCALE    1 or 2
// SAMPLES  look-ups a pixel, at least 4

layout(binding = 0) uniform sampler2D u_depth;   // metres along the camera's axis
layout(binding = 1) uniform sampler2D u_normal;  // unit, model space
layout(location = 4) uniform vec2 u_reach;       // x: radius (metres), y: strength

layout(location = 0) out float f_open;           // 1: nothing stands before the sky

ivec2 scenePixel() {
  ivec2 last = textureSize(u_depth, 0) - 1;
  return min(ivec2(gl_FragCoord.xy) * SCALE, last);
}

float depthAt(vec2 pixel) {
  return texelFetch(u_depth, clamp(ivec2(pixel), ivec2(0), textureSize(u_depth, 0) - 1), 0).r;
}

vec3 viewNormal(ivec2 pixel) {
  return normalizeOrZero(u_view_rotation * (texelFetch(u_normal, pixel, 0).xyz));
}

// A number in [0, 1) for each of 4 x 4 pixels, all different: what the blur averages out.
float tileNoise() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  return (float((p.x + p.y) & 3) * 4.0 + float(p.x)) / 16.0;
}
