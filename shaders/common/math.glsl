// SPDX-License-Identifier: Apache-2.0

const float PI = 3.14159265358979;

float saturate(float x) { return clamp(x, 0.0, 1.0); }

// A vector without length stays one, where normalize() would give NaN and a black pixel.
vec3 normalizeOrZero(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-24)); }

// Of linear light with sRGB's primaries.
float luminance(vec3 colour) { return dot(colour, vec3(0.2126, 0.7152, 0.0722)); }

float pow5(float x) {
  float x2 = x * x;
  return x2 * x2 * x;
}

