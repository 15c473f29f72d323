// SPDX-License-Identifier: Apache-2.0
#include "common/view.glsl"
#include "occlusion/openness.glsl"
#include "skin/skin_light.glsl"
#include "scene/stored_facet.glsl"

// Lights the facets that scene/surface.frag.glsl stored. Runs only on pixels with a surface.
// Ambient occlusion reduces the sky's light.
//
// OCCLUSION  1: u_open is bound
// EMISSION   1: u_emission is bound
// SHADOWS_BEFORE  1: the shadow maps are those of the former picture, and u_motion is bound

layout(binding = 0) uniform sampler2D u_colour;     // see struct StoredFacet
layout(binding = 1) uniform sampler2D u_normal;
layout(binding = 2) uniform sampler2D u_geometric;
layout(binding = 3) uniform sampler2D u_matter;
layout(binding = 4) uniform sampler2D u_depth;      // metres along the camera's axis
#if OCCLUSION
layout(binding = 10) uniform sampler2D u_open;
#endif
#if EMISSION
layout(binding = 11) uniform sampler2D u_emission;
#endif
#if SHADOWS_BEFORE
layout(binding = 12) uniform sampler2D u_motion;      // see motionOf() of scene/motion.glsl
layout(location = 5) uniform mat3 u_before_rotation;  // model space to the former view space
layout(location = 8) uniform vec4 u_before_position;  // the former camera; w: metres to its focus
layout(location = 9) uniform vec2 u_before_lens;      // slopes at the right and upper edges
#endif
layout(location = 4) uniform float u_range;         // largest depth difference that mixes, metres

layout(location = 0) out vec4 f_irradiance;  // see struct Leaving
layout(location = 1) out vec4 f_radiance;
layout(location = 2) out vec4 f_albedo;

// The stored facet of a pixel at depth `metres`, model space.
Facet facetAt(ivec2 pixel, float metres) {
  vec3 inView = viewPosition(vec2(pixel) + 0.5, metres);
  StoredFacet stored =
      StoredFacet(texelFetch(u_colour, pixel, 0), texelFetch(u_normal, pixel, 0),
                  texelFetch(u_geometric, pixel, 0), texelFetch(u_matter, pixel, 0));
  return loadFacet(stored, u_camera_position.xyz + inView * u_view_rotation);
}

#if SHADOWS_BEFORE
// Where the former picture had the surface of a pixel, model space.
vec3 positionBefore(ivec2 pixel) {
  vec2 here = 2.0 * (vec2(pixel) + 0.5 - u_lens.yz) / vec2(textureSize(u_depth, 0));
  vec3 motion = texelFetch(u_motion, pixel, 0).xyz;
  float metres = motion.z + u_before_position.w;
  vec3 inView = metres * vec3((here + motion.xy) * u_before_lens, -1.0);
  return u_before_position.xyz + inView * u_before_rotation;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float metres = texelFetch(u_depth, pixel, 0).r;
  Facet facet = facetAt(pixel, metres);
#if EMISSION
  facet.emission = texelFetch(u_emission, pixel, 0).rgb;
#endif
#if SHADOWS_BEFORE
  vec3 mapped = positionBefore(pixel);
#else
  vec3 mapped = facet.position;
#endif
  Lit lit = lightFacet(facet, mapped);
#if OCCLUSION
  float open = openAt(u_open, u_depth, pixel, metres, u_range);
  lit.sky *= facet.kind == MATERIAL_SKIN ? openForDiffuse(open) : withBounces(open, facet.colour);
  lit.skySpecular *= open;
#endif
  Leaving leaving = leavingLight(facet, lit, metres);
  f_irradiance = leaving.irradiance;
  f_radiance = vec4(leaving.radiance, 0.0);
  f_albedo = vec4(leaving.albedo, 0.0);
}
