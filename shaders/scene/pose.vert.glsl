// SPDX-License-Identifier: Apache-2.0
#include "scene/skinning.glsl"
#if WRINKLE_DYNAMIC
#include "wrinkles/wrinkles_vert.glsl"
#endif
#if MORPH_PARTS
#include "scene/morph.glsl"
#endif

// Poses a mesh for several subjects, one per instance. It draws nothing: transform feedback
// captures the output for every pass that draws the mesh (render/scene/posed_meshes.h).

// Mirrors character::Vertex. Model space, rest pose, metres.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_tangent;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in uvec4 a_joints;
layout(location = 5) in vec4 a_skin_weights;
#if DISPLACED
layout(location = 6) in float a_share;  // share of the heights; 0 on the mesh's border
#endif
layout(location = 7) in uint a_subject;
#if MORPH_PARTS
layout(location = 8) in uint a_morph_row;
#endif
#if GRADIENTS
// render/mesh/weight_gradients.h: changes of the skin weights per metre along the surface.
layout(location = 9) in vec4 a_weights_along;
layout(location = 10) in vec4 a_weights_across;
#endif

layout(xfb_buffer = 0, xfb_stride = 52 + 4 * DISPLACED + 16 * WRINKLE_DYNAMIC * MAP_SLOTS) out;
layout(location = 0, xfb_offset = 0) out vec3 p_position;  // model space of the picture
layout(location = 1, xfb_offset = 12) out vec3 p_normal;
layout(location = 2, xfb_offset = 24) out vec4 p_tangent;   // GRADIENTS: see stretchedSlope()
layout(location = 3, xfb_offset = 40) out vec2 p_uv;
layout(location = 4, xfb_offset = 48) flat out uint p_subject;
#if DISPLACED
layout(location = 5, xfb_offset = 52) out float p_share;
#endif
#if WRINKLE_DYNAMIC
layout(location = 6, xfb_offset = 52 + 4 * DISPLACED) out vec4 p_dynamic_masks[MAP_SLOTS];
#endif

void main() {
  JointMatrices joints = jointMatrices(a_subject, a_joints);
  SkinMatrix skin = blendJoints(joints, a_skin_weights);
  vec3 position = a_position;
  vec3 normal = a_normal;
  vec3 tangent = a_tangent.xyz;
#if MORPH_PARTS
  position += morphSum(a_morph_row, 0u);
#endif
#if MORPH_PARTS > 1
  normal = morphDirection(normal, morphSum(a_morph_row, 1u));
#endif
#if MORPH_PARTS > 2
  tangent = morphDirection(tangent, morphSum(a_morph_row, 2u));
#endif
  p_position = skinPoint(skin, position);
  p_normal = skinDirection(skin, normal);
#if GRADIENTS
  vec3 restAcross = normalizeOrZero(cross(normal, tangent));
  vec3 across = skinDirection(skin, restAcross);
  vec3 along = skinDirection(skin, normalizeOrZero(cross(restAcross, normal)));
  vec3 turnedAlong = along;
  vec3 turnedAcross = across;
  addWeightChanges(joints, position, p_position, a_weights_along, a_weights_across,
                   along, across);
  p_normal = surfaceNormal(p_normal, along, across);
  vec2 stretch = stretchOf(along, across, turnedAlong, turnedAcross);
  p_tangent = vec4(normalizeOrZero(along) * stretch.x, a_tangent.w * stretch.y);
#else
  p_tangent = vec4(skinDirection(skin, tangent), a_tangent.w);
#endif
  p_uv = a_uv;
  p_subject = a_subject;
#if DISPLACED
  p_share = a_share;
#endif
#if WRINKLE_DYNAMIC
  // By the rest pose: masks belong to places of the skin, which morph targets move along.
  dynamicMasksAt(a_position, a_subject, a_joints, a_skin_weights, p_dynamic_masks);
#endif
}
