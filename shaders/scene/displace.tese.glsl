// SPDX-License-Identifier: Apache-2.0
#include "scene/displacement.glsl"
#include "shadow/shadow_view.glsl"

// Moves the surface along its normal by the heights of the active wrinkle maps. The normal and
// tangent stay those of the undisplaced surface: the derivative maps are the slopes of the same
// heights and already tilt that normal.
//
// SHADOW  1: draw as lamp u_light sees it

layout(triangles, fractional_odd_spacing, ccw) in;

layout(binding = 12) uniform sampler2DArray u_wrinkle_heights;  // red: millimetres
layout(location = 1) uniform float u_height_texel;              // size of a texel on the surface,
                                                                // metres

layout(location = 0) in vec3 c_position[];
layout(location = 1) in vec3 c_normal[];
layout(location = 2) in vec4 c_tangent[];
layout(location = 3) in vec2 c_uv[];
layout(location = 4) in float c_share[];
layout(location = 5) in Place c_start[];
layout(location = 8) in Place c_end[];
layout(location = 11) in Place c_corner[];
#if CROWD
layout(location = 15) in uint c_subject[];
#endif
#if WRINKLE_DYNAMIC
layout(location = 16) in vec4 c_dynamic_masks[][MAP_SLOTS];
#endif

#if SHADOW
layout(location = 0) uniform int u_light;
#else
layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out vec4 v_tangent;
#if CROWD
layout(location = 5) flat out uint v_subject;
#endif
#if WRINKLE_DYNAMIC
layout(location = 6) out vec4 v_dynamic_masks[MAP_SLOTS];
#endif
#endif
layout(location = 3) out vec2 v_uv;

// Height above the surface in millimetres. `lod`: mip level of the heights.
float heightAt(vec2 uv, vec4 dynamicMasks[MAP_SLOTS], float lod) {
  vec4 masks[MASK_LAYERS];
  masksAt(uv, 0.0, masks);
  float sum = 0.0;
  for (int i = 0; i < ACTIVE_MAPS; ++i) {
    ActiveMap map = u_active_maps[i];
    if (map.heightLayer < 0) continue;
    float height = textureLod(u_wrinkle_heights, vec3(uv, float(map.heightLayer)), lod).r;
    sum += wrinkleCoefficient(i, masks, dynamicMasks) * map.amplitude * height;
  }
  return sum;
}

// The point of the undisplaced surface. Every patch that shares the point computes it with the same
// operations.
Place placeHere(vec3 at) {
  precise Place place;
  place.position = at.x * c_position[0] + at.y * c_position[1] + at.z * c_position[2];
  place.normal = at.x * c_normal[0] + at.y * c_normal[1] + at.z * c_normal[2];
  place.uv = at.x * c_uv[0] + at.y * c_uv[1] + at.z * c_uv[2];
  for (int i = 0; i < 3; ++i) {
    int next = (i + 1) % 3;
    if (at[i] == 1.0) return c_corner[i];
    if (at[(i + 2) % 3] != 0.0) continue;
    place.position = at[i] * c_start[i].position + at[next] * c_end[i].position;
    place.normal = at[i] * c_start[i].normal + at[next] * c_end[i].normal;
    place.uv = at[i] * c_start[i].uv + at[next] * c_end[i].uv;
  }
  return place;
}

// The mip level with texels as large as the distance between vertices. It depends on the position
// only, not on the patch's levels, so that all neighbours agree.
float lodAt(vec3 position) {
  float apart = u_displacement.z * distance(position, u_camera_position.xyz) / u_displacement.y;
  return max(log2(apart / u_height_texel), 0.0);
}

void main() {
  vec3 at = gl_TessCoord;
#if CROWD
  currentSubject = c_subject[0];
#endif
  Place place = placeHere(at);
  precise float share = at.x * c_share[0] + at.y * c_share[1] + at.z * c_share[2];
  vec4 dynamicMasks[MAP_SLOTS];
#if WRINKLE_DYNAMIC
  for (int slot = 0; slot < MAP_SLOTS; ++slot) {
    precise vec4 mask = at.x * c_dynamic_masks[0][slot] + at.y * c_dynamic_masks[1][slot] +
                        at.z * c_dynamic_masks[2][slot];
    dynamicMasks[slot] = mask;
  }
#else
  for (int slot = 0; slot < MAP_SLOTS; ++slot) dynamicMasks[slot] = vec4(0.0);
#endif
  float millimetres = heightAt(place.uv, dynamicMasks, lodAt(place.position));
  precise vec3 moved = place.position +
                       normalizeOrZero(place.normal) * (share * u_displacement.x * millimetres);
  v_uv = at.x * c_uv[0] + at.y * c_uv[1] + at.z * c_uv[2];
#if SHADOW
  gl_Position = shadowPosition(u_lights[u_light], moved);
#else
  v_position = moved;
  v_normal = at.x * c_normal[0] + at.y * c_normal[1] + at.z * c_normal[2];
  v_tangent = at.x * c_tangent[0] + at.y * c_tangent[1] + at.z * c_tangent[2];
#if CROWD
  v_subject = c_subject[0];
#endif
#if WRINKLE_DYNAMIC
  v_dynamic_masks = dynamicMasks;
#endif
  gl_Position = u_view_projection * vec4(moved, 1.0);
#endif
}
