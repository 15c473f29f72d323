// SPDX-License-Identifier: Apache-2.0
#include "scene/facet_frag.glsl"
#include "scene/stored_facet.glsl"

// The scene pass of the skin pipeline where it has one sample a pixel: the facets alone, which
// skin/light.frag.glsl lights afterwards. Triangles are often smaller than the squares of pixels that a
// device shades at once, and hair lies in layers; this way light falls once on every pixel.

layout(location = 0) out vec4 f_colour;     // see scene/stored_facet.glsl
layout(location = 1) out vec4 f_normal;
layout(location = 2) out vec4 f_geometric;
layout(location = 3) out vec4 f_matter;
layout(location = 4) out float f_depth;     // metres along the camera's axis

void main() {
  Facet facet = facetHere();
  StoredFacet stored = storeFacet(facet);
  f_colour = stored.colour;
  f_normal = stored.normal;
  f_geometric = stored.geometric;
  f_matter = stored.matter;
  f_depth = depthOf(facet.position);
}
