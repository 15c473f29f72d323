// SPDX-License-Identifier: Apache-2.0

const float SMALLEST_M = 0.03125;  // below it Beckmann's table is full

// All that light needs to know of a point of the surface. Model space.
struct Facet {
  int kind;         // MATERIAL_SKIN, ...
  vec3 position;
  vec3 colour;      // base colour, linear
  vec3 normal;      // unit; of the shading, with wrinkles
  vec3 geometric;   // unit
  float m;          // Beckmann's, [SMALLEST_M, 1]
  float curvature;  // 1 / mm
  float thickness;  // metres of flesh that light meets at least
  float open;       // share of the light that gets into painted hollows, [0, 1]
  float crease;     // ... and into the folds of the wrinkle maps
};
