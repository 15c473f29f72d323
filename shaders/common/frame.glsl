// SPDX-License-Identifier: Apache-2.0
// Values that are constant within a frame. Mirrors FrameBlock of render/scene/frame_block.h. Space:
// model space of the character (right-handed, Y up, metres).

const int NUM_LIGHTS = 3;

struct Light {
  vec4 position;     // xyz; w: 1, or 0 for a directional light
  vec4 direction;    // xyz: unit, towards the light; w: cosine at a spot's edge, -1: no spot
  vec4 radiance;     // rgb: linear, irradiance over pi at normal incidence; w: squared distance for
                     // which rgb is given
  mat4 shadow_view;  // model space to the lamp's space, which looks along its -z
  vec4 shadow;       // x: scale to the map's [-1, 1], y: near plane, z: 1 / range (metres), w: 1
                     // for a perspective projection
};

layout(std140, binding = 0) uniform Frame {
  mat4 u_view_projection;
  vec4 u_camera_position;    // xyz
  vec4 u_camera_forward;     // xyz: unit; w: focus distance (metres)
  Light u_lights[NUM_LIGHTS];
  vec4 u_ambient[9];         // rgb: diffuse light of the sky as a polynomial
                             // (render/scene/sky_light.h)
  vec4 u_sky_zenith;         // rgb: radiance from straight above
  vec4 u_sky_horizon;        // rgb: radiance from the horizon
  vec4 u_sky_ground;         // rgb: radiance from straight below
  vec4 u_shadow_filter;      // x: softness, y: lamp radius, z: normal offset (metres), w: texels
                             // per side of a map
  vec4 u_gloss;              // x: rho_s, y: scale of m, z: share of the second lobe, w: share of
                             // the albedo before scattering
  vec4 u_translucency;       // x: strength, y: scale, z: shrink (metres), w: subsurface strength
  vec4 u_wrinkle_maps;       // x: blood flow, y: cavity
  vec4 u_displacement;       // x: metres per millimetre of height, y: pixels of an object as tall
                             // as its distance, z: edge length (pixels), w: largest level
};

// Unshadowed light of a lamp at a point that faces it: irradiance over pi.
struct Arrival {
  vec3 toLight;   // unit
  vec3 radiance;  // linear
};

// Light of a lamp at `position` (model space, metres), without shadow. Inverse-square falloff for
// spots and points.
Arrival arrivalOf(Light light, vec3 position) {
  vec3 towards = light.position.xyz - position;
  float distance2 = max(dot(towards, towards), 1e-6);
  vec3 toLight = light.position.w > 0.5 ? towards * inversesqrt(distance2) : light.direction.xyz;
  float falloff = light.position.w > 0.5 ? light.radiance.w / distance2 : 1.0;
  float edge = light.direction.w;
  float cosine = dot(toLight, light.direction.xyz);
  // The soft rim of a spot covers a quarter of the cosine range between edge and axis.
  float cone = smoothstep(edge, mix(edge, 1.0, 0.25), cosine);
  return Arrival(toLight, light.radiance.rgb * falloff * (edge > -1.0 ? cone : 1.0));
}

// Diffuse light of the sky on a surface of unit normal `n` (model space): irradiance over pi,
// linear, at least 0 (Ramamoorthi and Hanrahan 2001).
vec3 skyIrradiance(vec3 n) {
  vec3 sum = u_ambient[0].rgb + n.y * u_ambient[1].rgb + n.z * u_ambient[2].rgb +
             n.x * u_ambient[3].rgb + n.x * n.y * u_ambient[4].rgb +
             n.y * n.z * u_ambient[5].rgb + (3.0 * n.z * n.z - 1.0) * u_ambient[6].rgb +
             n.x * n.z * u_ambient[7].rgb + (n.x * n.x - n.y * n.y) * u_ambient[8].rgb;
  return max(sum, vec3(0.0));
}

// Radiance of the sky in a unit direction (model space), linear.
vec3 skyRadiance(vec3 direction) {
  vec3 pole = direction.y > 0.0 ? u_sky_zenith.rgb : u_sky_ground.rgb;
  return mix(u_sky_horizon.rgb, pole, direction.y * direction.y);
}
