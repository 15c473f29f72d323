// SPDX-License-Identifier: Apache-2.0
#include "scene/facet.glsl"
#include "common/frame.glsl"
#include "scene/surface_frag.glsl"

// Builds the facet of a fragment from the material's textures and the active wrinkles.
//
// MATERIAL       MATERIAL_SKIN, _CLOTH, _EYE, _HAIR or _OTHER
// WIDEN          1: m grows by the variance of the slopes within the pixel
// WRINKLE_LOOKS  1: some wrinkle map has a colour or a cavity
// COMPOSED_LOOKS 1: the base colour already includes them, with the cavity in its alpha
// HAS_THICKNESS  1: the material has a thickness texture

#if HAS_THICKNESS
layout(binding = 11) uniform sampler2D u_thickness_map;  // green, as in glTF
#endif

// Smallest thickness of flesh that light passes through from any direction, metres.
float thickness() {
#if HAS_THICKNESS
  return u_thickness * texture(u_thickness_map, textureUv()).g;
#else
  return u_thickness;
#endif
}

// Curvature of the surface, 1 / radius, per millimetre. `normal`: unit, model space.
float curvatureOf(vec3 normal) {
  return length(fwidth(normal)) / max(1000.0 * length(fwidth(v_position)), 1e-6);
}

// The facet of this fragment. Discards the fragment where its texture is cut out.
Facet facetHere() {
  vec4 masks[MASK_LAYERS];
  vec4 dynamicMasks[MAP_SLOTS];
  Facet facet;
  facet.kind = MATERIAL;
  facet.position = v_position;
  vec4 base = beginSurface(masks, dynamicMasks);
  facet.colour = base.rgb;
  facet.emission = emission();
  facet.geometric = normalizeOrZero(facesCamera() ? v_normal : -v_normal);
  float variance;
  facet.normal = surfaceNormal(masks, dynamicMasks, variance);
  float rough = roughness();
  facet.m = u_gloss.y * rough * rough;
#if WIDEN
  facet.m = sqrt(facet.m * facet.m + 2.0 * variance);  // Beckmann's m^2 is twice the variance
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

// Depth of a point (model space) along the camera's axis, metres.
float depthOf(vec3 position) { return dot(position - u_camera_position.xyz, u_camera_forward.xyz); }
