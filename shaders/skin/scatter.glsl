// SPDX-License-Identifier: Apache-2.0

// How the light on skin is kept: rgb times albedo^mix, and in alpha metres behind the focus.

const float FAR_AWAY = 60000.0;  // alpha where there is no skin: exchanges light with nothing

bool isSkin(vec4 light) { return light.a < 0.5 * FAR_AWAY; }
