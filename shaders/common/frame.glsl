// SPDX-License-Identifier: Apache-2.0
// What is the same for all of a frame. Mirrors FrameBlock of render/scene/frame_block.h.
// Space: model space of the character (right-handed, Y up, metres).

const int NUM_LIGHTS = 3;

struct Light {
  vec4 position;     // xyz; w: 1, or 0 for a light that has a direction alone
  vec4 direction;    // xyz: unit, towards the light; w: cosine at a spot's edge, -1: no spot
  vec4 radiance;     // rgb: linear, irradiance over pi at normal incidence; w: squared distance at
                     // which it holds
  mat4 shadow_view;  // model space to the lamp's, which looks down its -z
  vec4 shadow;       // x: scale to the map's [-1, 1], y: near plane, z: 1 / range (metres),
                     // w: 1 for a perspective
};

layout(std140, binding = 0) uniform Frame {
  mat4 u_view_projection;
  vec4 u_camera_position;    // xyz
  vec4 u_camera_forward;     // xyz: unit; w: distance of the focus
  Light u_lights[NUM_LIGHTS];
  vec4 u_ambient[9];         // rgb: diffuse light of the sky, a polynomial (render/scene/sky_light.h)
  vec4 u_sky_zenith;         // rgb: radiance from above,
  vec4 u_sky_horizon;        // from all around
  vec4 u_sky_ground;         // and from below
  vec4 u_shadow_filter;      // x: softness, y: lamp's radius, z: normal offset (metres),
                             // w: texels of a map's side
  vec4 u_gloss;              // x: rho_s, y: scale of m, z: share of the second lobe,
                             // w: share of the albedo before scattering
  vec4 u_translucency;       // x: strength, y: scale, z: shrink (metres), w: subsurface strength
  vec4 u_wrinkle_maps;       // x: blood flow, y: cavity
  vec4 u_displacement;       // x: metres a millimetre of height, y: pixels of what is as tall as far,
                             // z: pixels of an edge, w: most levels
};

// What of a lamp arrives at a point that faces it, without shadow: irradiance over pi.
struct Arrival {
  vec3 toLight;   // unit
  vec3 radiance;  // linear
};

Arrival arrivalOf(Light light, vec3 position) {
  vec3 towards = light.position.xyz - position;
  float distance2 = max(dot(towards, towards), 1e-6);
  vec3 toLight = light.position.w > 0.5 ? towards * inversesqrt(distance2) : light.direction.xyz;
  float falloff = light.position.w > 0.5 ? light.radiance.w / distance2 : 1.0;
  float edge = light.direction.w;
  float cosine = dot(toLight, light.direction.xyz);
  // A spot's rim is as wide as a quarter of what is between its edge and its axis.
  float cone = smoothstep(edge, mix(edge, 1.0, 0.25), cosine);
  return Arrival(toLight, light.radiance.rgb * falloff * (edge > -1.0 ? cone : 1.0));
}

// Diffuse light of the sky on a unit normal: irradiance over pi.
vec3 skyIrradiance(vec3 n) {
  vec3 sum = u_ambient[0].rgb + n.y * u_ambient[1].rgb + n.z * u_ambient[2].rgb +
             n.x * u_ambient[3].rgb + n.x * n.y * u_ambient[4].rgb +
             n.y * n.z * u_ambient[5].rgb + (3.0 * n.z * n.z - 1.0) * u_ambient[6].rgb +
             n.x * n.z * u_ambient[7].rgb + (n.x * n.x - n.y * n.y) * u_ambient[8].rgb;
  return max(sum, vec3(0.0));
}

// Radiance of the sky in a unit direction.
vec3 skyRadiance(vec3 direction) {
  vec3 pole = direction.y > 0.0 ? u_sky_zenith.rgb : u_sky_ground.rgb;
  return mix(u_sky_horizon.rgb, pole, direction.y * direction.y);
}
