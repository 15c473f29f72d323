// SPDX-License-Identifier: Apache-2.0
#include "common_frame.glsl"
#include "common_math.glsl"

struct Surface {
  vec3 albedo;      // linear, [0, 1]
  vec3 normal;      // unit, model space
  float exponent;   // of the Blinn-Phong lobe, >= 1
  float specular;   // scales the lobe; reflectance F0 is folded in
};

// Ambient light from a sky above and a ground below, without occlusion. Linear radiance.
vec3 ambientRadiance(vec3 normal) {
  return mix(u_ambient_ground.rgb, u_ambient_sky.rgb, normal.y * 0.5 + 0.5);
}

// Blinn-Phong, normalised so that a wider lobe is dimmer: (n + 8) / 8 over pi, pi being in the
// lights' units; with Schlick's Fresnel, scaled so that it is 1 face on.
float specularLobe(Surface surface, vec3 toLight, vec3 toCamera) {
  vec3 h = normalizeOrZero(toLight + toCamera);
  float fresnel = 1.0 + 24.0 * pow5(1.0 - saturate(dot(h, toCamera)));
  float lobe = pow(max(dot(surface.normal, h), 1e-4), surface.exponent);
  return surface.specular * fresnel * (surface.exponent + 8.0) * 0.125 * lobe;
}

// Light that leaves the surface towards the camera. Linear radiance.
vec3 shade(Surface surface, vec3 toCamera) {
  vec3 diffuse = ambientRadiance(surface.normal);
  vec3 specular = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    vec3 toLight = u_lights[i].direction.xyz;
    float cosine = saturate(dot(surface.normal, toLight));
    vec3 irradiance = u_lights[i].radiance.rgb * cosine;
    diffuse += irradiance;
    specular += irradiance * specularLobe(surface, toLight, toCamera);
  }
  return surface.albedo * diffuse + specular;
}
