// SPDX-License-Identifier: Apache-2.0
#include "scene/facet_frag.glsl"
#include "skin/skin_light.glsl"

// The skin pipeline's scene pass with several samples per pixel. It separates the light on skin
// from all other light and stores the surface's properties for later passes. With one sample per
// pixel, scene/surface.frag.glsl and skin/light.frag.glsl do the same in two passes.

layout(location = 0) out vec4 f_irradiance;  // see struct Leaving
layout(location = 1) out vec4 f_radiance;    // rgb; a: the sky's share of it
layout(location = 2) out vec4 f_albedo;      // rgb; a: the sky's share of f_irradiance
layout(location = 3) out vec4 f_normal;      // xyz: unit, model space
layout(location = 4) out float f_depth;      // metres along the camera's axis

// Share of luminance of `part` in `whole`, [0, 1].
float share(vec3 part, vec3 whole) {
  return saturate(luminance(part) / max(luminance(whole), 1e-6));
}

void main() {
  Facet facet = facetHere();
  Lit lit = lightFacet(facet, facet.position);
  float metres = depthOf(facet.position);
  Leaving leaving = leavingLight(facet, lit, metres);
  float skyOfDiffuse = share(lit.sky, lit.direct + lit.sky + lit.through);
#if MATERIAL == MATERIAL_SKIN
  float skyOfRest = share(lit.skySpecular, leaving.radiance);
#else
  float skyOfRest = share(facet.colour * lit.sky + lit.skySpecular, leaving.radiance);
#endif
  f_irradiance = leaving.irradiance;
  f_radiance = vec4(leaving.radiance, VIEW == VIEW_FINAL ? skyOfRest : 0.0);
  f_albedo = vec4(leaving.albedo, skyOfDiffuse);
  f_normal = vec4(facet.normal, 0.0);
  f_depth = metres;
}
