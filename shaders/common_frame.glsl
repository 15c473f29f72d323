// SPDX-License-Identifier: Apache-2.0
// What is the same for all of a frame. Mirrors FrameBlock in render/passes/scene_pass.cpp.
// Space: model space of the character (right-handed, Y up, metres).

struct Light {
  vec4 direction;  // xyz: unit, towards the light
  vec4 radiance;   // rgb: linear, irradiance over pi at normal incidence
};

layout(std140, binding = 0) uniform Frame {
  mat4 u_view_projection;
  vec4 u_camera_position;   // xyz
  Light u_lights[3];
  vec4 u_ambient_sky;       // rgb: linear radiance from above
  vec4 u_ambient_ground;    // rgb: from below
};
