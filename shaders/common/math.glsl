// SPDX-License-Identifier: Apache-2.0

const float PI = 3.14159265358979;

// Clamps to [0, 1].
float saturate(float x) { return clamp(x, 0.0, 1.0); }

// Like normalize(), but returns 0 for a zero vector, where normalize() would give NaN and a black
// pixel.
vec3 normalizeOrZero(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-24)); }

// Luminance of linear light with sRGB primaries.
float luminance(vec3 colour) { return dot(colour, vec3(0.2126, 0.7152, 0.0722)); }

// The fifth power, for Schlick's Fresnel term.
float pow5(float x) {
  float x2 = x * x;
  return x2 * x2 * x;
}

