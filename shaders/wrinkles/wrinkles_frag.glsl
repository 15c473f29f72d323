// SPDX-License-Identifier: Apache-2.0
#include "common/normals.glsl"
#include "wrinkles/masks.glsl"

layout(binding = 3) uniform sampler2DArray u_wrinkle_derivatives;  // n.xy / n.z, and their squares
#if WRINKLE_LOOKS
layout(binding = 10) uniform sampler2DArray u_wrinkle_looks;       // rgb: colour, a: cavity
#endif

// xy: derivative, z: its variance within the pixel, as the mean of both axes.
vec3 slopeOf(vec4 moments) {
  vec2 variance = max(moments.ba - moments.rg * moments.rg, vec2(0.0));
  return vec3(moments.rg, 0.5 * (variance.x + variance.y));
}

// Slope and variance of one wrinkle map at full weight, as slopeOf().
vec3 wrinkleSlope(ActiveMap map, vec2 uv) {
  vec3 slope = slopeOf(texture(u_wrinkle_derivatives, vec3(uv, float(map.layer))));
  return slope * vec3(map.amplitude, map.amplitude, map.amplitude * map.amplitude);
}

// Unit tangent-space normal of the base surface with wrinkles. `base`: slope of the base map. Adds
// the maps' variance to `variance`, assuming that the maps are independent.
vec3 wrinkledNormal(vec2 base, vec2 uv, vec4 masks[MASK_LAYERS], vec4 dynamicMasks[MAP_SLOTS],
                    inout float variance) {
#if NORMAL_BLEND == 0
  // Partial derivatives: p = p_base + sum w_i p_i. Heights add up, so the sum is exact.
  vec2 p = base;
  for (int i = 0; i < ACTIVE_MAPS; ++i) {
    ActiveMap map = u_active_maps[i];
    float w = wrinkleCoefficient(i, masks, dynamicMasks);
    vec3 slope = wrinkleSlope(map, uv);
    p += w * slope.xy;
    variance += w * w * slope.z;
  }
  return normalFromDerivative(p);
#else
  // Thesis 4.5 with weights: normalize(b.xy + sum w_i n_i.xy, b.z * prod mix(1, n_i.z, w_i)).
  vec3 b = normalFromDerivative(base);
  for (int i = 0; i < ACTIVE_MAPS; ++i) {
    ActiveMap map = u_active_maps[i];
    float w = wrinkleCoefficient(i, masks, dynamicMasks);
    vec3 slope = wrinkleSlope(map, uv);
    vec3 n = normalFromDerivative(slope.xy);
    variance += w * w * slope.z;
    b.xy += w * n.xy;
    b.z *= mix(1.0, n.z, min(w, 1.0));
  }
  return normalize(b);
#endif
}

// Thesis, figure 4.3: the maps' colours, each times its coefficient. Linear, may exceed 1.
vec3 wrinkleColour(vec4 masks[MASK_LAYERS], vec4 dynamicMasks[MAP_SLOTS]) {
  vec3 colour = vec3(0.0);
  for (int i = 0; i < ACTIVE_MAPS; ++i) {
    colour += wrinkleCoefficient(i, masks, dynamicMasks) * u_active_maps[i].colour.rgb;
  }
  return colour;
}

#if WRINKLE_LOOKS
// Factors by which the maps' colours (rgb) and cavities (a) change the base colour and the incoming
// light. `strength`: x: of colours, y: of cavities.
vec4 wrinkleLook(vec2 uv, vec4 masks[MASK_LAYERS], vec4 dynamicMasks[MAP_SLOTS], vec2 strength) {
  vec4 look = vec4(1.0);
  for (int i = 0; i < ACTIVE_MAPS; ++i) {
    vec4 texel = texture(u_wrinkle_looks, vec3(uv, float(u_active_maps[i].map)));
    texel.rgb *= u_active_maps[i].colour.a;
    float w = wrinkleCoefficient(i, masks, dynamicMasks);
    look *= max(mix(vec4(1.0), texel, w * strength.xxxy), vec4(0.0));
  }
  return look;
}
#endif
