// SPDX-License-Identifier: Apache-2.0
#include "scene/displacement.glsl"

// Chooses how finely a triangle is divided: by the length of its edges in the camera's picture, for
// camera and lamps alike. Triangles without displacement are not divided.

layout(vertices = 3) out;

const float RAISED = 1.0 / 255.0;  // smallest sum of coefficients that counts as displaced
const float AROUND = 2.0;          // mip of the masks that covers the area between the sampled
                                   // points

layout(location = 0) in vec3 v_position[];
layout(location = 1) in vec3 v_normal[];
layout(location = 2) in vec4 v_tangent[];
layout(location = 3) in vec2 v_uv[];
layout(location = 4) in float v_share[];
#if CROWD
layout(location = 5) in uint v_subject[];
#endif
#if WRINKLE_DYNAMIC
layout(location = 6) in vec4 v_dynamic_masks[][MAP_SLOTS];
#endif

layout(location = 0) out vec3 c_position[];
layout(location = 1) out vec3 c_normal[];
layout(location = 2) out vec4 c_tangent[];
layout(location = 3) out vec2 c_uv[];
layout(location = 4) out float c_share[];
layout(location = 5) out Place c_start[];   // owner of the edge from this corner to the next: its
                                            // start
layout(location = 8) out Place c_end[];
layout(location = 11) out Place c_corner[];  // owner of this corner
layout(location = 14) out float c_level[];   // of the edge from this corner to the next
#if CROWD
layout(location = 15) out uint c_subject[];
#endif
#if WRINKLE_DYNAMIC
layout(location = 16) out vec4 c_dynamic_masks[][MAP_SLOTS];
#endif

// A vertex of the patch as a Place.
Place placeOf(int vertex) { return Place(v_position[vertex], v_normal[vertex], v_uv[vertex]); }

// Returns true if any wrinkle map is active around `uv`.
bool isRaised(vec2 uv, vec4 dynamicMasks[MAP_SLOTS]) {
  vec4 masks[MASK_LAYERS];
  masksAt(uv, AROUND, masks);
  float sum = 0.0;
  for (int i = 0; i < ACTIVE_MAPS; ++i) sum += wrinkleCoefficient(i, masks, dynamicMasks);
  return sum > RAISED;
}

// Tessellation level of an edge, [1, largest level]. Symmetric in start and end, so that both
// neighbours agree.
float edgeLevel(Place start, Place end) {
  vec3 middle = 0.5 * (start.position + end.position);
  float away = max(distance(middle, u_camera_position.xyz), 1e-4);
  float pixels = distance(start.position, end.position) * u_displacement.y / away;
  return clamp(pixels / u_displacement.z, 1.0, u_displacement.w);
}

void main() {
  int corner = gl_InvocationID;
  c_position[gl_InvocationID] = v_position[corner];
  c_normal[gl_InvocationID] = v_normal[corner];
  c_tangent[gl_InvocationID] = v_tangent[corner];
  c_uv[gl_InvocationID] = v_uv[corner];
  c_share[gl_InvocationID] = v_share[corner];
#if CROWD
  currentSubject = c_subject[gl_InvocationID] = v_subject[corner];
#endif
  Place start = placeOf(3 + 2 * corner);
  Place end = placeOf(4 + 2 * corner);
  c_start[gl_InvocationID] = start;
  c_end[gl_InvocationID] = end;
  c_corner[gl_InvocationID] = placeOf(9 + corner);
  vec4 here[MAP_SLOTS];
  vec4 there[MAP_SLOTS];
  vec4 between[MAP_SLOTS];
#if WRINKLE_DYNAMIC
  c_dynamic_masks[gl_InvocationID] = v_dynamic_masks[corner];
  here = v_dynamic_masks[3 + 2 * corner];
  there = v_dynamic_masks[4 + 2 * corner];
  for (int slot = 0; slot < MAP_SLOTS; ++slot) between[slot] = 0.5 * (here[slot] + there[slot]);
#else
  for (int slot = 0; slot < MAP_SLOTS; ++slot) here[slot] = there[slot] = between[slot] = vec4(0.0);
#endif
  bool raised = isRaised(start.uv, here) || isRaised(end.uv, there) ||
                isRaised(0.5 * (start.uv + end.uv), between);
  c_level[gl_InvocationID] = raised ? edgeLevel(start, end) : 1.0;
  barrier();
  if (corner != 0) return;
  // OpenGL numbers an edge by the opposite corner.
  gl_TessLevelOuter[0] = c_level[1];
  gl_TessLevelOuter[1] = c_level[2];
  gl_TessLevelOuter[2] = c_level[0];
  gl_TessLevelInner[0] = max(c_level[0], max(c_level[1], c_level[2]));
}
