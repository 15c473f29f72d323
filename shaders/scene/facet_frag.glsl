// SPDX-License-Identifier: Apache-2.0
#include "scene/facet.glsl"
#include "common/frame.glsl"
#include "scene/surface_frag.glsl"

// The facet of a fragment, from the material's textures and the wrinkles at work.
//
// MATERIAL       MATERIAL_SKIN, _CLOTH, _EYE, _HAIR or _OTHER
// WIDEN          1: gloss is wider where the pixel covers many slopes
// WRINKLE_LOOKS  1: some wrinkle map has a colour or a cavity
// COMPOSED_LOOKS 1: the base colour has some already, and their cavity in its alpha
// HAS_THICKNESS  1: the material has a texture of its flesh's thickness

#if HAS_THICKNESS
layout(binding = 11) uniform sampler2D u_thickness_map;  // green, as in glTF
#endif

// Metres of flesh that light meets at least, wherever it comes from.
float thickness() {
#if HAS_THICKNESS
  return u_thickness * texture(u_thickness_map, v_uv).g;
#else
  return u_thickness;
#endif
}

// 1 / radius of the surface, per millimetre.
float curvatureOf(vec3 normal) {
  return length(fwidth(normal)) / max(1000.0 * length(fwidth(v_position)), 1e-6);
}

Facet facetHere() {
  vec4 masks[MASK_LAYERS];
  vec4 dynamicMasks[MAP_SLOTS];
  Facet facet;
  facet.kind = MATERIAL;
  facet.position = v_position;
  vec4 base = beginSurface(masks, dynamicMasks);
  facet.colour = base.rgb;
  facet.geometric = normalizeOrZero(facesCamera() ? v_normal : -v_normal);
  float variance;
  facet.normal = surfaceNormal(masks, dynamicMasks, variance);
  float rough = roughness();
  facet.m = u_gloss.y * rough * rough;
#if WIDEN
  facet.m = sqrt(facet.m * facet.m + 2.0 * variance);  // Beckmann's m^2 is twice the slopes' variance
#endif
  facet.m = clamp(facet.m, SMALLEST_M, 1.0);
  facet.curvature = curvatureOf(facet.geometric);
  facet.thickness = thickness();
  facet.open = cavity(facet.colour);
  facet.crease = COMPOSED_LOOKS == 1 ? base.a : 1.0;
#if WRINKLE_LOOKS && (WRINKLE_TEXTURE || WRINKLE_DYNAMIC)
  vec4 look = wrinkleLook(v_uv, masks, dynamicMasks, u_wrinkle_maps.xy);
  facet.colour *= look.rgb;
  facet.crease *= look.a;
#endif
  return facet;
}

// Metres of a point along the camera's axis.
float depthOf(vec3 position) { return dot(position - u_camera_position.xyz, u_camera_forward.xyz); }
