// SPDX-License-Identifier: Apache-2.0
#include "scene/facet.glsl"
#include "common/math.glsl"

// Kelemen and Szirmay-Kalos' specular term (2001) as GPU Gems 3, chapter 14, made it for skin.
//
// BECKMANN_SIZE, ALBEDO_SIZE  texels of the tables' sides
// BECKMANN_TABLE  1: PH is looked up; 0: it is worked out, where look-ups cost more than arithmetic
// SPECULAR_GEMS  1: as printed, without the 1/pi that makes it a distribution
// Both tables are render/skin/beckmann.h's; their texels' centres lie on the ends of both ranges.

#if BECKMANN_TABLE
layout(binding = 7) uniform sampler2D u_beckmann_table;  // 0.5 PH^0.1; x: N.H, y: m
#endif
// f0 r + (1 - f0) g, b and a of m / 2; x: cosine, y: m
layout(binding = 8) uniform sampler2D u_albedo_table;

vec2 tablePlace(float cosine, float m, float size) {
  return (vec2(cosine, m) * (size - 1.0) + 0.5) / size;
}

// PH = exp(-tan^2 / m^2) / (m^2 cos^4).
float beckmann(float cosine, float m) {
#if BECKMANN_TABLE
  float t = textureLod(u_beckmann_table, tablePlace(cosine, m, BECKMANN_SIZE), 0.0).r;
  float t2 = 4.0 * t * t;
  float t4 = t2 * t2;
  return t4 * t4 * t2;
#else
  float cos2 = max(cosine * cosine, 1e-4);  // 0/0 there; the limit is 0
  float m2 = m * m;
  return exp((cos2 - 1.0) / (cos2 * m2)) / (m2 * cos2 * cos2);
#endif
}

float schlick(float cosine, float f0) { return f0 + (1.0 - f0) * pow5(1.0 - cosine); }

// Two lobes, m and m / 2 by `second`. Light that is reflected per light that arrives from
// `toLight`, in the lights' unit (times pi), before the cosine.
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

// Share of light from `cosine` that the specular term reflects in all, rho_s left out, [0, 1].
float specularAlbedo(float cosine, float m, float second, float f0) {
  vec4 lobes = textureLod(u_albedo_table, tablePlace(cosine, m, ALBEDO_SIZE), 0.0);
  vec2 albedo = mix(lobes.xy, lobes.zw, second);
  float reflected = f0 * albedo.r + (1.0 - f0) * albedo.g;
#if SPECULAR_GEMS
  reflected *= PI;
#endif
  return saturate(reflected);
}
