// SPDX-License-Identifier: Apache-2.0

// Fast approximate anti-aliasing (Lottes 2009, the short form): where luma jumps, the picture is
// averaged along the edge.

layout(binding = 0) uniform sampler2D u_picture;  // display-referred, linear filter

layout(location = 0) out vec4 f_colour;

float luma(vec3 colour) { return dot(colour, vec3(0.299, 0.587, 0.114)); }

vec3 at(vec2 pixel) {
  vec2 size = vec2(textureSize(u_picture, 0));
  return textureLod(u_picture, clamp(pixel, vec2(0.5), size - 0.5) / size, 0.0).rgb;
}

void main() {
  vec2 pixel = gl_FragCoord.xy;
  vec3 centre = at(pixel);
  float m = luma(centre);
  float nw = luma(at(pixel + vec2(-1.0, -1.0)));
  float ne = luma(at(pixel + vec2(1.0, -1.0)));
  float sw = luma(at(pixel + vec2(-1.0, 1.0)));
  float se = luma(at(pixel + vec2(1.0, 1.0)));
  float low = min(m, min(min(nw, ne), min(sw, se)));
  float high = max(m, max(max(nw, ne), max(sw, se)));
  if (high - low < max(0.03, 0.1 * high)) {
    f_colour = vec4(centre, 1.0);
    return;
  }
  vec2 along = vec2((sw + se) - (nw + ne), (nw + sw) - (ne + se));
  float damp = max((nw + ne + sw + se) * 0.03125, 1.0 / 128.0);
  along = clamp(along / (min(abs(along.x), abs(along.y)) + damp), vec2(-8.0), vec2(8.0));
  vec3 narrow = 0.5 * (at(pixel - along / 6.0) + at(pixel + along / 6.0));
  vec3 wide = 0.5 * narrow + 0.25 * (at(pixel - 0.5 * along) + at(pixel + 0.5 * along));
  float l = luma(wide);
  f_colour = vec4(l < low || l > high ? narrow : wide, 1.0);
}
