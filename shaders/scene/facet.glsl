// SPDX-License-Identifier: Apache-2.0

const float SMALLEST_M = 0.03125;  // the Beckmann table saturates below this

// Everything that lighting needs to know about a point of the surface. Model space.
struct Facet {
  int kind;         // MATERIAL_SKIN, ...
  vec3 position;
  vec3 colour;      // base colour, linear
  vec3 normal;      // unit; shading normal with wrinkles
  vec3 geometric;   // unit
  float m;          // Beckmann's, [SMALLEST_M, 1]
  float curvature;  // 1 / mm
  float thickness;  // metres of flesh that light passes through, at least
  float open;       // share of light that enters painted hollows, [0, 1]
  float crease;     // share of light that enters the folds of wrinkle maps, [0, 1]
  vec3 emission;    // light that the surface sends out, linear
};
