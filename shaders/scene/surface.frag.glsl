// SPDX-License-Identifier: Apache-2.0
#include "scene/facet_frag.glsl"
#include "scene/stored_facet.glsl"

// The skin pipeline's scene pass with one sample per pixel. It stores facets, and
// skin/light.frag.glsl lights them afterwards, once per pixel. Triangles are often smaller than the
// blocks of pixels that a device shades at once, and hair has many layers, so lighting every
// fragment would be wasteful.

layout(location = 0) out vec4 f_colour;     // see scene/stored_facet.glsl
layout(location = 1) out vec4 f_normal;
layout(location = 2) out vec4 f_geometric;
layout(location = 3) out vec4 f_matter;
layout(location = 4) out float f_depth;     // metres along the camera's axis
#if EMISSION_TARGET
layout(location = 5) out vec4 f_emission;   // rgb; see struct Facet
#endif
#if MOTION
layout(location = 5) noperspective in vec3 v_motion;
layout(location = 5 + EMISSION_TARGET) out vec4 f_motion;  // see motionOf() of scene/motion.glsl
#endif

void main() {
  Facet facet = facetHere();
  StoredFacet stored = storeFacet(facet);
  f_colour = stored.colour;
  f_normal = stored.normal;
  f_geometric = stored.geometric;
  f_matter = stored.matter;
  f_depth = depthOf(facet.position);
#if EMISSION_TARGET
  f_emission = vec4(facet.emission, 0.0);
#endif
#if MOTION
  f_motion = vec4(v_motion, 0.0);
#endif
}
