// SPDX-License-Identifier: Apache-2.0
#include "common/texel.glsl"

// Fast approximate anti-aliasing (Lottes 2009, short form). Averages the picture along edges in
// luma.

layout(binding = 0) uniform sampler2D u_picture;  // rgb: display-referred, a: luma; linear filter

layout(location = 0) out vec4 f_colour;

// The picture at `pixel` (centres at halves), clamped to the border.
vec4 at(vec2 pixel) {
  vec2 size = vec2(textureSize(u_picture, 0));
  return textureLod(u_picture, clamp(pixel, vec2(0.5), size - 0.5) / size, 0.0);
}

// Averages along the edge that the lumas of the four corner pixels indicate. `low`, `high`: range
// of the neighbourhood's lumas.
vec4 smoothed(float nw, float ne, float sw, float se, float low, float high) {
  vec2 pixel = gl_FragCoord.xy;
  vec2 along = vec2((sw + se) - (nw + ne), (nw + sw) - (ne + se));
  float damp = max((nw + ne + sw + se) * 0.03125, 1.0 / 128.0);
  along = clamp(along / (min(abs(along.x), abs(along.y)) + damp), vec2(-8.0), vec2(8.0));
  vec4 narrow = 0.5 * (at(pixel - along / 6.0) + at(pixel + along / 6.0));
  vec4 wide = 0.5 * narrow + 0.25 * (at(pixel - 0.5 * along) + at(pixel + 0.5 * along));
  return wide.a < low || wide.a > high ? narrow : wide;
}

// Luma of a neighbouring pixel.
float lumaBeside(ivec2 offset) {
  return texelInside(u_picture, ivec2(gl_FragCoord.xy) + offset).a;
}

void main() {
  vec4 centre = texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0);
  float m = centre.a;
  float nw = lumaBeside(ivec2(-1, -1));
  float ne = lumaBeside(ivec2(1, -1));
  float sw = lumaBeside(ivec2(-1, 1));
  float se = lumaBeside(ivec2(1, 1));
  float low = min(m, min(min(nw, ne), min(sw, se)));
  float high = max(m, max(max(nw, ne), max(sw, se)));
  f_colour = centre;
  // A loop instead of a branch: groups of pixels without an edge skip it.
  int edges = high - low < max(0.03, 0.1 * high) ? 0 : 1;
  for (int i = 0; i < edges; ++i) f_colour = smoothed(nw, ne, sw, se, low, high);
}
