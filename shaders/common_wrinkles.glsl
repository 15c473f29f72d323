// SPDX-License-Identifier: Apache-2.0
// The wrinkle maps that this frame needs: an active list made on the CPU, so that a map whose wrinkle
// weights are all 0 costs nothing. Mirrors ActiveMap in render/wrinkle_table.h.
//
// MASK_LAYERS  RGBA mask textures of the character, at least 1
// MAP_SLOTS    vec4s that carry the dynamic masks of the active maps, at least 1

struct ActiveMap {
  vec4 colour;          // rgb: linear, for the views `weights` and `mask_dynamic`
  int layer;            // in u_wrinkle_derivatives; -1: the map has no texture
  int map;              // column in u_joint_influences
  float amplitude;      // scales the derivatives
  int lambda;           // 0 smooth, 1 binary, 2 linear
  float smoothWidth;    // w0 of the smooth lambda
};

layout(std430, binding = 1) readonly buffer WrinkleTable {
  int u_active_count;
  int u_map_count;      // columns of u_joint_influences
  ActiveMap u_active_maps[];
};

// One row an active map, one vec4 a mask layer: the wrinkle weight of the region in each channel.
layout(std430, binding = 2) readonly buffer MaskWeights { vec4 u_mask_weights[]; };

// num_joints x u_map_count, joint-major, in [0, 1] (wrinkle::JointInfluenceJob).
layout(std430, binding = 3) readonly buffer JointInfluences { float u_joint_influences[]; };
