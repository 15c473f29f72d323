// SPDX-License-Identifier: Apache-2.0
// The wrinkle maps that this frame needs: an active list made on the CPU, so that a map whose
// wrinkle weights are all 0 costs nothing. Mirrors ActiveMap and WrinkleBlock() in
// render/wrinkle_table.h.
//
// ACTIVE_MAPS  length of the list for this surface: a constant, so that loops unroll and llvmpipe
//              reads the list once for all lanes, which a list in a storage buffer cannot
// MASK_LAYERS  RGBA mask textures of the character, at least 1
// MAP_SLOTS    vec4s that carry the dynamic masks of the rig's maps, at least 1

struct ActiveMap {
  vec4 colour;          // rgb: linear, for the views `weights` and `mask_dynamic`
  int layer;            // in u_wrinkle_derivatives
  int map;              // column in u_joint_influences
  float amplitude;      // scales the derivatives
  int lambda;           // 0 smooth, 1 binary, 2 linear
  float smoothWidth;    // w0 of the smooth lambda
  int heightLayer;      // in u_wrinkle_heights; -1: none
};

layout(std140, binding = 2) uniform WrinkleTable {
  int u_map_count;      // columns of u_joint_influences
  ActiveMap u_active_maps[4 * MAP_SLOTS];
  // One row an active map, one vec4 a mask layer: the wrinkle weight of the region in each channel.
  vec4 u_mask_weights[4 * MAP_SLOTS * MASK_LAYERS];
};

// num_joints x u_map_count, joint-major, in [0, 1] (wrinkle::JointInfluenceJob).
layout(std430, binding = 1) readonly buffer JointInfluences { float u_joint_influences[]; };
