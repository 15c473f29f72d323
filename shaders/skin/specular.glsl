// SPDX-License-Identifier: Apache-2.0
#include "scene/facet.glsl"
#include "common/math.glsl"

// The specular term of Kelemen and Szirmay-Kalos (2001) in the form of GPU Gems 3, chapter 14, for
// skin.
//
// BECKMANN_SIZE   texels per side of u_beckmann_table
// ALBEDO_SIZE     texels per side of u_albedo_table
// BECKMANN_TABLE  1: look up PH; 0: compute it, which is faster where look-ups are expensive
// SPECULAR_GEMS   1: as printed, without the factor 1/pi that normalises the distribution
//
// Both tables come from render/skin/beckmann.h. Their outer texel centres lie at the ends of the
// ranges.

#if BECKMANN_TABLE
layout(binding = 7) uniform sampler2D u_beckmann_table;  // 0.5 PH^0.1; x: N.H, y: m
#endif
// rg: for m, ba: for m / 2; albedo = f0 r + (1 - f0) g. x: cosine, y: m.
layout(binding = 8) uniform sampler2D u_albedo_table;

// UV in a table of `size` texels per side, for arguments in [0, 1].
vec2 tablePlace(float cosine, float m, float size) {
  return (vec2(cosine, m) * (size - 1.0) + 0.5) / size;
}

// The Beckmann term PH = exp(-tan^2 / m^2) / (m^2 cos^4) for the cosine between normal and half
// vector.
float beckmann(float cosine, float m) {
#if BECKMANN_TABLE
  float t = textureLod(u_beckmann_table, tablePlace(cosine, m, BECKMANN_SIZE), 0.0).r;
  float t2 = 4.0 * t * t;
  float t4 = t2 * t2;
  return t4 * t4 * t2;
#else
  float cos2 = max(cosine * cosine, 1e-4);  // avoids 0/0; the limit is 0
  float m2 = m * m;
  return exp((cos2 - 1.0) / (cos2 * m2)) / (m2 * cos2 * cos2);
#endif
}

// Schlick's Fresnel approximation; `cosine` in [0, 1].
float schlick(float cosine, float f0) { return f0 + (1.0 - f0) * pow5(1.0 - cosine); }

// Reflected light per light that arrives from `toLight`, before the cosine, in the lights' unit
// (times pi). Mixes two lobes, m and m / 2, by `second`. Directions are unit.
float kelemen(vec3 normal, vec3 toLight, vec3 toCamera, float m, float second, float f0) {
  vec3 h = toLight + toCamera;  // not unit: its square is the visibility term
  float h2 = max(dot(h, h), 1e-6);
  float invH = inversesqrt(h2);
  float cosine = saturate(dot(normal, h) * invH);
  float ph = mix(beckmann(cosine, m), beckmann(cosine, max(0.5 * m, SMALLEST_M)), second);
  float fresnel = schlick(saturate(dot(h, toCamera) * invH), f0);
  float reflected = ph * fresnel / h2;
#if SPECULAR_GEMS
  reflected *= PI;
#endif
  return reflected;
}

// Share of light from `cosine` that the specular term reflects in total, without rho_s, [0, 1].
float specularAlbedo(float cosine, float m, float second, float f0) {
  vec4 lobes = textureLod(u_albedo_table, tablePlace(cosine, m, ALBEDO_SIZE), 0.0);
  vec2 albedo = mix(lobes.xy, lobes.zw, second);
  float reflected = f0 * albedo.r + (1.0 - f0) * albedo.g;
#if SPECULAR_GEMS
  reflected *= PI;
#endif
  return saturate(reflected);
}
