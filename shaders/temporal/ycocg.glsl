// SPDX-License-Identifier: Apache-2.0

// Brightness (x) and two colour differences (y, z) of display-referred colours: colours of one
// surface lie closer together along these axes than along red, green and blue.
vec3 toYcocg(vec3 c) {
  return vec3(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * c.r - 0.5 * c.b,
              -0.25 * c.r + 0.5 * c.g - 0.25 * c.b);
}

vec3 fromYcocg(vec3 c) {
  return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z);
}
