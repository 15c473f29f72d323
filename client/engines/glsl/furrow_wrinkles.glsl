// SPDX-License-Identifier: Apache-2.0
// Wrinkles over a base normal map, for GLSL 3.30 and later and GLSL ES 3.00 (WebGL 2). The blend is
// that of Furrow's own renderer (shaders/wrinkles/wrinkles_frag.glsl, NORMAL_BLEND 0): the slopes of
// the base and of all wrinkle maps are added. Heights add up, so the sum is exact, and the pores of
// the base survive.
//
// A slope is n.xy / n.z of a tangent-space normal: x runs along the tangent (u), y along the
// bitangent, which points up in the picture (-v in glTF).

// Slope of a texel of a normal map. Only the ratio matters, so mip levels need no normalisation.
vec2 furrowSlope(vec3 texel) {
  vec3 n = 2.0 * texel - 1.0;
  return clamp(n.xy / max(n.z, 0.001), -16.0, 16.0);
}

// Unit tangent-space normal of a slope.
vec3 furrowNormal(vec2 slope) { return normalize(vec3(slope, 1.0)); }

// Factors by which a wrinkle map's colour (rgb) and cavity (a) at coefficient `c` change what is
// drawn. `texel`: colour, linear and times its scale, and cavity.
vec4 furrowLook(vec4 look, vec4 texel, float c) {
  return look * max(mix(vec4(1.0), texel, c), vec4(0.0));
}

// Linear colour of an sRGB texel that the GPU has not converted.
vec3 furrowLinear(vec3 srgb) {
  return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), step(0.04045, srgb));
}
