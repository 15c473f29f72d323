// SPDX-License-Identifier: Apache-2.0

// Storage format of light on skin. rgb: light times albedo^mix; a: metres behind the focus.

const float FAR_AWAY = 60000.0;  // alpha without skin; too far away to exchange light with skin

// Returns true if a texel in this format is skin.
bool isSkin(vec4 light) { return light.a < 0.5 * FAR_AWAY; }
