// SPDX-License-Identifier: Apache-2.0
#include "scene/facet.glsl"

// A facet as scene/surface.frag.glsl stores it for skin/light.frag.glsl. The position follows from
// the depth.
//
// MAX_CURVATURE  largest stored curvature, per mm

struct StoredFacet {
  vec4 colour;     // 8 bits: square root of the base colour, for perceptually even steps; a: crease
  vec4 normal;     // half floats: normal; a: m
  vec4 geometric;  // 8 bits: 0.5 n + 0.5; a: open
  vec4 matter;     // 8 bits: kind, thickness, curvature
};

const float MOST_THICKNESS = 0.032;  // metres; no visible light passes through more

// Encodes a facet. Thickness and curvature are clamped when they are written.
StoredFacet storeFacet(Facet facet) {
  return StoredFacet(vec4(sqrt(facet.colour), facet.crease), vec4(facet.normal, facet.m),
                     vec4(facet.geometric * 0.5 + 0.5, facet.open),
                     vec4(float(facet.kind) / 255.0, facet.thickness / MOST_THICKNESS,
                          facet.curvature / MAX_CURVATURE, 0.0));
}

// Decodes a facet at `position` (model space), without its emission.
Facet loadFacet(StoredFacet stored, vec3 position) {
  return Facet(int(stored.matter.r * 255.0 + 0.5), position, stored.colour.rgb * stored.colour.rgb,
               normalizeOrZero(stored.normal.xyz), normalizeOrZero(stored.geometric.xyz * 2.0 - 1.0),
               stored.normal.w, stored.matter.b * MAX_CURVATURE, stored.matter.g * MOST_THICKNESS,
               stored.geometric.w, stored.colour.w, vec3(0.0));
}
