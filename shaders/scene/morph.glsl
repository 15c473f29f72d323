// SPDX-License-Identifier: Apache-2.0

// MORPH_PARTS  what the sums hold: 1 positions, 2 also normals, 3 also tangents

// Sums of the morph targets, instance after instance, row after row, part after part. Model space,
// rest pose, metres. Row 0 is zero. A texture for the reason of u_joint_rows (scene/skinning.glsl).
layout(binding = 16) uniform samplerBuffer u_morph_sums;
layout(location = 0) uniform uint u_morph_rows;  // per instance

vec3 morphSum(uint row, uint part) {
  uint texel = (uint(gl_InstanceID) * u_morph_rows + row) * uint(MORPH_PARTS) + part;
  return texelFetch(u_morph_sums, int(texel)).xyz;
}

// Turns a unit direction by a sum. Returns a unit vector, and `direction` if the sum cancels it.
vec3 morphDirection(vec3 direction, vec3 sum) {
  vec3 turned = direction + sum;
  float square = dot(turned, turned);
  return square > 1e-12 ? turned * inversesqrt(square) : direction;
}
