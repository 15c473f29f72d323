// SPDX-License-Identifier: Apache-2.0
#include "scene/facet.glsl"

// A facet as scene/surface.frag.glsl leaves it to skin/light.frag.glsl; its position is in the depth.
//
// MAX_CURVATURE  per mm

struct StoredFacet {
  vec4 colour;     // 8 bits: square root of the base colour, whose steps the eye sees alike; crease
  vec4 normal;     // half floats: the normal, m
  vec4 geometric;  // 8 bits: 0.5 n + 0.5, open
  vec4 matter;     // 8 bits: kind, thickness, curvature
};

const float MOST_THICKNESS = 0.032;  // metres; no light comes through so much

StoredFacet storeFacet(Facet facet) {
  return StoredFacet(vec4(sqrt(facet.colour), facet.crease), vec4(facet.normal, facet.m),
                     vec4(facet.geometric * 0.5 + 0.5, facet.open),
                     vec4(float(facet.kind) / 255.0, facet.thickness / MOST_THICKNESS,
                          facet.curvature / MAX_CURVATURE, 0.0));
}

Facet loadFacet(StoredFacet stored, vec3 position) {
  return Facet(int(stored.matter.r * 255.0 + 0.5), position, stored.colour.rgb * stored.colour.rgb,
               normalizeOrZero(stored.normal.xyz), normalizeOrZero(stored.geometric.xyz * 2.0 - 1.0),
               stored.normal.w, stored.matter.b * MAX_CURVATURE, stored.matter.g * MOST_THICKNESS,
               stored.geometric.w, stored.colour.w);
}
