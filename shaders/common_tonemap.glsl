// SPDX-License-Identifier: Apache-2.0

// Khronos PBR Neutral (2024): colours below 0.76 keep their hue and nearly their value, highlights
// are compressed and desaturated. Linear in, linear [0, 1] out.
vec3 tonemapNeutral(vec3 colour) {
  const float startCompression = 0.8 - 0.04;
  const float desaturation = 0.15;
  float low = min(colour.r, min(colour.g, colour.b));
  float offset = low < 0.08 ? low - 6.25 * low * low : 0.04;
  colour -= offset;
  float peak = max(colour.r, max(colour.g, colour.b));
  if (peak < startCompression) return colour;
  const float d = 1.0 - startCompression;
  float newPeak = 1.0 - d * d / (peak + d - startCompression);
  colour *= newPeak / peak;
  float g = 1.0 - 1.0 / (desaturation * (peak - newPeak) + 1.0);
  return mix(colour, vec3(newPeak), g);
}

// Linear [0, 1] to sRGB's transfer curve (IEC 61966-2-1).
vec3 linearToSrgb(vec3 colour) {
  vec3 low = colour * 12.92;
  vec3 high = 1.055 * pow(max(colour, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055;
  return mix(high, low, lessThanEqual(colour, vec3(0.0031308)));
}
