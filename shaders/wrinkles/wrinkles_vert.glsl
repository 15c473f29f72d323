// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"

// Masks that are evaluated per vertex. Mirrors DynamicMaskBlock of render/wrinkles/dynamic_masks.h.
//
// NUM_JOINTS  joints of the character's skeleton
// MAP_SLOTS   vec4s per vertex for the dynamic masks of all maps
struct DynamicMask {
  int slot;           // active map that it raises
  int column;         // of u_joint_influences; -1: a sliding mask
  int lambda;         // 0 smooth, 1 binary, 2 linear
  float smoothWidth;  // w0 of the smooth lambda
  // The remaining members describe a sliding mask around a joint. Lengths are relative to the bone
  // below the joint.
  vec4 origin;        // xyz: rest pose; w: the wrinkle weight
  vec4 towards;       // xyz: direction that the joint moves to; w: cosine at which the mask reaches 0
  vec4 bone;          // xyz: unit; w: 1 / length (1/m)
  vec4 extent;        // above, below, radius
};

// Subjects x joints x u_mask_columns, in [0, 1] (wrinkle::JointInfluenceJob).
layout(std430, binding = 1) readonly buffer JointInfluences { float u_joint_influences[]; };
// Only masks above 0, subject after subject: joints at rest cost nothing.
layout(std430, binding = 3) readonly buffer DynamicMasks {
  int u_mask_columns;
  DynamicMask u_dynamic_masks[];
};
// Start of each subject's masks, and the end.
layout(std430, binding = 4) readonly buffer FirstMasks { uint u_first_masks[]; };

// Share of a joint's influence that a vertex takes, [0, 1], by its skin weight in [0, 1] (thesis
// 4.2). The smooth form has no seam where a skin weight fades out.
float lambdaOf(DynamicMask mask, float skinWeight) {
  if (mask.lambda == 1) return skinWeight > 0.0 ? 1.0 : 0.0;
  if (mask.lambda == 2) return skinWeight;
  return smoothstep(0.0, max(mask.smoothWidth, 1e-6), skinWeight);
}

// Thesis 4.2: the sum of lambda(skin weight) * influence over the vertex's joints.
// wrinkleCoefficient() clamps it to [0, 1].
float skinnedMask(DynamicMask mask, uint subject, uvec4 joints, vec4 skinWeights) {
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    uint row = subject * uint(NUM_JOINTS) + joints[i];
    float influence = u_joint_influences[row * uint(u_mask_columns) + uint(mask.column)];
    sum += lambdaOf(mask, skinWeights[i]) * influence;
  }
  return sum;
}

// wrinkle::SlidingMaskAt() times the wrinkle weight. `position`: rest pose, model space, metres.
float slidingMask(DynamicMask mask, vec3 position) {
  const float SOFT = 0.4;  // share of length and radius over which the mask fades out
  vec3 offset = (position - mask.origin.xyz) * mask.bone.w;
  float along = dot(offset, mask.bone.xyz);
  vec3 across = offset - along * mask.bone.xyz;
  float away = length(across);
  float cosine = away > 1e-6 ? dot(across, mask.towards.xyz) / away : 0.0;
  float above = mask.extent.x;
  float below = mask.extent.y;
  float radius = mask.extent.z;
  float soft = SOFT * (above + below);
  return mask.origin.w * smoothstep(mask.towards.w, 1.0, cosine) *
         smoothstep(-above, soft - above, along) *
         (1.0 - smoothstep(below - soft, below, along)) *
         (1.0 - smoothstep((1.0 - SOFT) * radius, radius, away));
}

// Sums the masks of all active maps at a vertex, not yet clamped. `position`: rest pose, model
// space.
void dynamicMasksAt(vec3 position, uint subject, uvec4 joints, vec4 skinWeights,
                    out vec4 masks[MAP_SLOTS]) {
  for (int slot = 0; slot < MAP_SLOTS; ++slot) masks[slot] = vec4(0.0);
  for (uint i = u_first_masks[subject]; i < u_first_masks[subject + 1u]; ++i) {
    DynamicMask mask = u_dynamic_masks[i];
    float value = mask.column < 0 ? slidingMask(mask, position)
                                  : skinnedMask(mask, subject, joints, skinWeights);
    masks[mask.slot >> 2][mask.slot & 3] += value;
  }
}
