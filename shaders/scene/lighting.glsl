// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"
#include "common/math.glsl"

struct Surface {
  vec3 albedo;      // linear, [0, 1]
  vec3 normal;      // unit, model space
  float exponent;   // of the Blinn-Phong lobe, >= 1
  float specular;   // scale of the lobe, including the reflectance F0
};

// Blinn-Phong lobe, normalised so that a wider lobe is dimmer: (n + 8) / 8 over pi, where pi is
// part of the lights' units. Includes Schlick's Fresnel term, scaled to 1 at normal incidence.
float specularLobe(Surface surface, vec3 toLight, vec3 toCamera) {
  vec3 h = normalizeOrZero(toLight + toCamera);
  float fresnel = 1.0 + 24.0 * pow5(1.0 - saturate(dot(h, toCamera)));
  float lobe = pow(max(dot(surface.normal, h), 1e-4), surface.exponent);
  return surface.specular * fresnel * (surface.exponent + 8.0) * 0.125 * lobe;
}

// Unshadowed light that leaves the surface at `position` towards the camera (`toCamera`: unit).
// Model space; linear radiance.
vec3 shade(Surface surface, vec3 position, vec3 toCamera) {
  vec3 diffuse = skyIrradiance(surface.normal);
  vec3 specular = vec3(0.0);
  for (int i = 0; i < NUM_LIGHTS; ++i) {
    Arrival arrival = arrivalOf(u_lights[i], position);
    vec3 irradiance = arrival.radiance * saturate(dot(surface.normal, arrival.toLight));
    diffuse += irradiance;
    specular += irradiance * specularLobe(surface, arrival.toLight, toCamera);
  }
  return surface.albedo * diffuse + specular;
}
