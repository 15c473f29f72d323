// SPDX-License-Identifier: Apache-2.0
// The active wrinkle maps of this frame. The CPU lists them, so that a map with all weights at 0
// costs nothing. Mirrors ActiveMap and WrinkleBlock() of render/wrinkles/wrinkle_table.h.
//
// ACTIVE_MAPS  length of the list for this surface. It is a constant in a uniform block, so that loops
//              unroll and llvmpipe reads the list once for all lanes.
// MASK_LAYERS  RGBA mask textures of the character, at least 1
// CROWD        1: several subjects, each with its own mask weights
// MAP_SLOTS    vec4s per vertex for the dynamic masks of all maps, at least 1

struct ActiveMap {
  vec4 colour;          // rgb: linear, for the views `weights` and `mask_dynamic`; a: value of a
                        // full texel of u_wrinkle_looks' colour
  int layer;            // in u_wrinkle_derivatives
  int map;              // in u_wrinkle_looks
  float amplitude;      // scale of derivatives and heights
  int heightLayer;      // in u_wrinkle_heights; -1: none
};

layout(std140, binding = 2) uniform WrinkleTable {
  ActiveMap u_active_maps[4 * MAP_SLOTS];
  // One row per active map, one vec4 per mask layer: the wrinkle weight of the region in each
  // channel. Used for a single subject.
  vec4 u_mask_weights[4 * MAP_SLOTS * MASK_LAYERS];
};
