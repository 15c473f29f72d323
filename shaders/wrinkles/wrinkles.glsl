// SPDX-License-Identifier: Apache-2.0
// The wrinkle maps that this frame needs: an active list made on the CPU, so that a map whose
// wrinkle weights are all 0 costs nothing. Mirrors ActiveMap and WrinkleBlock() in
// render/wrinkles/wrinkle_table.h.
//
// ACTIVE_MAPS  length of the list for this surface: a constant, so that loops unroll and llvmpipe
//              reads the list once for all lanes, which a list in a storage buffer cannot
// MASK_LAYERS  RGBA mask textures of the character, at least 1
// CROWD        1: several subjects are drawn, each with mask weights of its own
// MAP_SLOTS    vec4s that carry the dynamic masks of the rig's maps, at least 1

struct ActiveMap {
  vec4 colour;          // rgb: linear, for the views `weights` and `mask_dynamic`; a: what a full
                        // texel of u_wrinkle_looks' colour stands for
  int layer;            // in u_wrinkle_derivatives
  int map;              // in u_wrinkle_looks
  float amplitude;      // scales the derivatives and heights
  int heightLayer;      // in u_wrinkle_heights; -1: none
};

layout(std140, binding = 2) uniform WrinkleTable {
  ActiveMap u_active_maps[4 * MAP_SLOTS];
  // One row an active map, one vec4 a mask layer: the wrinkle weight of the region in each channel.
  // Of a frame's one subject.
  vec4 u_mask_weights[4 * MAP_SLOTS * MASK_LAYERS];
};
