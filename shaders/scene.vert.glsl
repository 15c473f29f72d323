// SPDX-License-Identifier: Apache-2.0
#include "common_frame.glsl"
#include "common_skinning.glsl"
#include "common_wrinkles_vert.glsl"

// Mirrors character::Vertex. Model space, rest pose, metres.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_tangent;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in uvec4 a_joints;
layout(location = 5) in vec4 a_skin_weights;
#if DISPLACED
layout(location = 6) in float a_share;  // of the heights: 0 on the mesh's border
#endif

layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out vec4 v_tangent;
layout(location = 3) out vec2 v_uv;
#if VIEW == VIEW_WIREFRAME
layout(location = 4) out vec3 v_barycentric;
#endif
#if DISPLACED
layout(location = 4) out float v_share;
#endif
#if WRINKLE_DYNAMIC
layout(location = 5) out vec4 v_dynamic_masks[MAP_SLOTS];
#endif

void main() {
  SkinMatrix skin = blendJoints(a_joints, a_skin_weights);
  v_position = skinPoint(skin, a_position);
  v_normal = skinDirection(skin, a_normal);
  v_tangent = vec4(skinDirection(skin, a_tangent.xyz), a_tangent.w);
  v_uv = a_uv;
#if VIEW == VIEW_WIREFRAME
  // Drawn without an index buffer: three vertices of its own to every triangle.
  v_barycentric = vec3(0.0);
  v_barycentric[gl_VertexID % 3] = 1.0;
#endif
#if WRINKLE_DYNAMIC
  dynamicMasksAt(a_position, a_joints, a_skin_weights, v_dynamic_masks);
#endif
#if DISPLACED
  v_share = a_share;
#else
  gl_Position = u_view_projection * vec4(v_position, 1.0);
#endif
}
