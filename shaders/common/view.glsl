// SPDX-License-Identifier: Apache-2.0

// Positions in view space (x right, y up, looking along -z; metres) from linear depth.

layout(location = 0) uniform mat3 u_view_rotation;  // model space to view space
layout(location = 3) uniform vec4 u_lens;           // x: pixels per unit slope; yz: the pixel on
                                                    // the camera's axis, near the centre

const float NO_SURFACE = 1e5;  // metres; anything farther is background

// View-space position at `pixel` (pixel centres at halves) and depth `metres` along the camera's
// axis.
vec3 viewPosition(vec2 pixel, float metres) {
  return metres * vec3((pixel - u_lens.yz) / u_lens.x, -1.0);
}
