// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"
#if MOTION
#include "scene/motion.glsl"
#endif

// A vertex as scene/pose.vert.glsl wrote it: skinned and placed.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_tangent;
layout(location = 3) in vec2 a_uv;
#if CROWD
layout(location = 4) in uint a_subject;
#endif
#if DISPLACED
layout(location = 5) in float a_share;
#endif
#if MOTION
layout(location = 5) in vec3 a_former;  // the position of the former picture
#endif
#if WRINKLE_DYNAMIC
layout(location = 6) in vec4 a_dynamic_masks[MAP_SLOTS];
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
#if CROWD
layout(location = 5) flat out uint v_subject;
#endif
#if MOTION
layout(location = 5) noperspective out vec3 v_motion;
#endif
#if WRINKLE_DYNAMIC
layout(location = 6) out vec4 v_dynamic_masks[MAP_SLOTS];
#endif

#if !DISPLACED
invariant gl_Position;  // cut-outs are drawn twice, and their depths must be equal
#endif

void main() {
  v_position = a_position;
  v_normal = a_normal;
  v_tangent = a_tangent;
  v_uv = a_uv;
#if VIEW == VIEW_WIREFRAME
  // This mesh is drawn without an index buffer, so each triangle has three vertices of its own.
  v_barycentric = vec3(0.0);
  v_barycentric[gl_VertexID % 3] = 1.0;
#endif
#if CROWD
  v_subject = a_subject;
#endif
#if WRINKLE_DYNAMIC
  v_dynamic_masks = a_dynamic_masks;
#endif
#if MOTION
  v_motion = motionOf(a_position, a_former);
#endif
#if DISPLACED
  v_share = a_share;
#else
  gl_Position = u_view_projection * vec4(v_position, 1.0);
#endif
}
