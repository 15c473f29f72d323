// SPDX-License-Identifier: Apache-2.0
// Wrinkles over a base normal map. The blend is that of Furrow's own renderer
// (shaders/wrinkles/wrinkles_frag.glsl, NORMAL_BLEND 0): the slopes of the base and of all wrinkle
// maps are added. Heights add up, so the sum is exact, and the pores of the base survive.
//
// A slope is n.xy / n.z of a tangent-space normal in the convention of the engine: green up in Unity,
// down in Unreal. The sum does not depend on it, as long as all maps have the same.
#ifndef FURROW_WRINKLES_INCLUDED
#define FURROW_WRINKLES_INCLUDED

// Slope of an unpacked normal, which need not have unit length.
float2 FurrowSlope(float3 n) { return clamp(n.xy / max(n.z, 0.001), -16.0, 16.0); }

// Unit tangent-space normal of a slope.
float3 FurrowNormal(float2 slope) { return normalize(float3(slope, 1.0)); }

// The normal of a texel with two channels (BC5) or three: z follows from x and y.
float3 FurrowUnpack(float2 texel) {
  float2 xy = 2.0 * texel - 1.0;
  return float3(xy, sqrt(max(1.0 - dot(xy, xy), 0.000001)));
}

// Factors by which a wrinkle map's colour (rgb) and cavity (a) at coefficient `c` change what is
// drawn. `texel`: colour, linear and times its scale, and cavity.
float4 FurrowLook(float4 look, float4 texel, float c) {
  return look * max(lerp(float4(1.0, 1.0, 1.0, 1.0), texel, c), 0.0);
}

#endif
