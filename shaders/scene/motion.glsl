// SPDX-License-Identifier: Apache-2.0

// Where the former picture of a stream showed the same points. Mirrors MotionBlock of
// render/scene/motion.h.

layout(std140, binding = 3) uniform Motion {
  mat4 u_clip_now;     // model space to clip space, without the jitter of the picture
  mat4 u_clip_before;  // the same for the former picture
  vec4 u_depth_before; // dot(u_depth_before, (position, 1)): metres behind the former focus
  vec4 u_detail;       // x: added to the level of textures
};

// xy: from the point `now` to the place where the former picture showed it, at `before` (both in
// model space), in normalised device coordinates; z: its depth there, metres behind the focus.
vec3 motionOf(vec3 now, vec3 before) {
  vec4 there = u_clip_before * vec4(before, 1.0);
  vec4 here = u_clip_now * vec4(now, 1.0);
  bool visible = there.w > 1e-3 && here.w > 1e-3;
  vec2 apart = visible ? there.xy / there.w - here.xy / here.w : vec2(0.0);
  return vec3(apart, dot(u_depth_before, vec4(before, 1.0)));
}
