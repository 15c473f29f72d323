// SPDX-License-Identifier: Apache-2.0

// Khronos PBR Neutral (2024) without its toe. The toe subtracts the 4% that a dielectric reflects
// everywhere, and our specular term has no such constant part. Colours below 0.76 stay unchanged;
// highlights are compressed and desaturated. Linear in, linear [0, 1] out.
vec3 tonemapNeutral(vec3 colour) {
  const float startCompression = 0.76;
  const float desaturation = 0.15;
  float peak = max(colour.r, max(colour.g, colour.b));
  const float d = 1.0 - startCompression;
  float newPeak = 1.0 - d * d / (peak + d - startCompression);
  float g = 1.0 - 1.0 / (desaturation * (peak - newPeak) + 1.0);
  vec3 compressed = mix(colour * (newPeak / peak), vec3(newPeak), g);
  return peak < startCompression ? colour : compressed;
}

// Converts linear [0, 1] to the sRGB transfer curve (IEC 61966-2-1).
vec3 linearToSrgb(vec3 colour) {
  vec3 low = colour * 12.92;
  vec3 high = 1.055 * pow(max(colour, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055;
  return mix(high, low, lessThanEqual(colour, vec3(0.0031308)));
}
