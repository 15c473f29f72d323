// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"
#include "common/math.glsl"

// Look-ups in the lamps' shadow maps, which lie side by side in one texture
// (render/scene/shadow_view.h).
//
// SHADOW_FILTER  0: none, 1: disc of fixed radius, 2: disc that widens with the distance between
//                caster and receiver (PCSS, Fernando 2005)
// SHADOW_TAPS    samples of the disc, at least 1

layout(binding = 5) uniform sampler2DShadow u_shadow_compare;  // linear: four comparisons each
layout(binding = 6) uniform sampler2D u_shadow_depth;          // nearest: metres / range

// A point (model space) as a lamp sees it. xy: [0, 1] in its map, z: depth, w: UV per metre at this
// distance.
vec4 shadowCoordinate(Light light, vec3 position) {
  vec3 p = (light.shadow_view * vec4(position, 1.0)).xyz;
  float scale = light.shadow.x / (light.shadow.w > 0.5 ? max(-p.z, 1e-6) : 1.0);
  return vec4(p.xy * scale * 0.5 + 0.5, (-p.z - light.shadow.y) * light.shadow.z, 0.5 * scale);
}

// Slope of a surface's plane in the shadow map: change of depth over UV. Samples on the side
// towards the lamp are compared with the plane and not with the point's depth, because the surface
// would otherwise shade itself (Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques").
// Samples on the other side are compared with the point's depth: smooth normals do not belong to a
// plane, and curved surfaces would shade themselves there.
const float STEEPEST = 5.0;
vec2 depthGradient(Light light, vec4 coordinate, vec3 normal) {
  vec3 n = mat3(light.shadow_view) * normal;
  // `way`: lateral movement of the light ray per metre of depth. `slope`: metres of depth per
  // lateral metre.
  vec2 way = light.shadow.w > 0.5 ? (coordinate.xy - 0.5) * (2.0 / light.shadow.x) : vec2(0.0);
  vec2 slope = n.xy / max(n.z - dot(n.xy, way), 1e-3);
  slope *= min(1.0, STEEPEST / max(length(slope), 1e-6));
  return slope * (light.shadow.z / coordinate.w);
}

// UV of a lamp's own map to UV of the texture of all maps. Stays half a texel inside the tile.
vec2 shadowTile(int light, vec2 uv) {
  float margin = 0.5 / u_shadow_filter.w;
  vec2 inside = clamp(uv, vec2(margin), vec2(1.0 - margin));
  return vec2((inside.x + float(light)) / float(NUM_LIGHTS), inside.y);
}

// Interleaved gradient noise (Jimenez 2014): [0, 1), evenly distributed over small blocks of
// pixels.
float pixelNoise(vec2 pixel) {
  return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}

// Vogel's spiral: points distributed evenly over the unit disc. The direction turns by the golden
// angle from one point to the next; discRadius() is the k-th point's distance from the centre.
const mat2 GOLDEN_TURN = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
const int RIM_TAPS = 4;
float discRadius(int k) { return sqrt((float(k) + 0.5) * (1.0 / float(SHADOW_TAPS))); }

// Mean depth of the blockers in front of `coordinate` within `radius` (UV); 1: no blocker.
float blockerDepth(int light, vec4 coordinate, vec2 gradient, float radius, vec2 direction) {
  float sum = 0.0;
  float count = 0.0;
  for (int k = 0; k < SHADOW_TAPS; ++k) {
    vec2 aside = radius * discRadius(k) * direction;
    direction = GOLDEN_TURN * direction;
    float depth = textureLod(u_shadow_depth, shadowTile(light, coordinate.xy + aside), 0.0).r;
    if (depth < coordinate.z + min(dot(gradient, aside), 0.0)) {
      sum += depth;
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 1.0;
}

// Radius of the filter on the surface, metres.
float shadowRadius(int light, vec4 coordinate, vec2 gradient, vec2 direction) {
#if SHADOW_FILTER == 2
  float search = min(u_shadow_filter.y * coordinate.w, 0.05);
  float blocker = blockerDepth(light, coordinate, gradient, search, direction);
  float range = 1.0 / u_lights[light].shadow.z;
  float toBlocker = u_lights[light].position.w > 0.5
                        ? u_lights[light].shadow.y + blocker * range
                        : 20.0 * u_camera_forward.w;  // directional lights: a typical distance of
                                                      // lamps
  float gap = max(coordinate.z - blocker, 0.0) * range;
  return clamp(u_shadow_filter.y * gap / max(toBlocker, 1e-3), 0.0, 0.05);
#else
  return u_shadow_filter.x;
#endif
}

// Visible share of a lamp, [0, 1]. `normal`: geometric, unit, model space. The sampled point is
// moved along the normal, farther at grazing angles, to prevent self-shadowing.
float shadowOf(int light, vec3 position, vec3 normal, vec3 toLight, vec2 pixel) {
#if SHADOW_FILTER == 0
  return 1.0;
#else
  float cosine = dot(normal, toLight);
  float grazing = sqrt(saturate(1.0 - cosine * cosine));
  float texel = 2.0 / (u_shadow_filter.w * u_lights[light].shadow.x) *
                (u_lights[light].shadow.w > 0.5
                     ? u_lights[light].shadow.y + 0.5 / u_lights[light].shadow.z : 1.0);
  float offset = u_shadow_filter.z + (texel + 0.5 * u_shadow_filter.x) * grazing;
  vec4 coordinate = shadowCoordinate(u_lights[light], position + offset * normal);
  vec2 gradient = depthGradient(u_lights[light], coordinate, normal);
  float turn = 6.2831853 * pixelNoise(pixel);
  vec2 direction = vec2(cos(turn), sin(turn));
  float radius = max(shadowRadius(light, coordinate, gradient, direction) * coordinate.w,
                     0.75 / u_shadow_filter.w);
  float lit = 0.0;
  // At the focus, the map covers what the picture shows. Points outside the map count as lit.
  bool isKnown = all(lessThan(abs(coordinate.xy - 0.5), vec2(0.5)));
  // Surfaces that face away need no samples. Groups of such pixels skip the loop.
  int taps = cosine > 0.0 && isKnown ? SHADOW_TAPS : 0;
  int looked = 0;
  for (; looked < taps; ++looked) {
    vec2 aside = radius * discRadius(SHADOW_TAPS - 1 - looked) * direction;
    direction = GOLDEN_TURN * direction;
    float depth = min(coordinate.z + min(dot(gradient, aside), 0.0), 0.9999);
    lit += textureLod(u_shadow_compare, vec3(shadowTile(light, coordinate.xy + aside), depth), 0.0);
    // The first taps are on the rim of the disc. If they agree, the taps inside do too.
    bool agree = looked == RIM_TAPS - 1 && (lit <= 0.0 || lit >= float(RIM_TAPS));
    taps = agree ? RIM_TAPS : taps;
  }
  return isKnown || cosine <= 0.0 ? lit / float(max(looked, 1)) : 1.0;
#endif
}

// Distance in metres along the lamp's axis from where light enters the subject to `coordinate`.
// Negative in front of the surface.
float depthBelowEntry(int light, vec4 coordinate) {
  float entry = textureLod(u_shadow_depth, shadowTile(light, coordinate.xy), 0.0).r;
  return (coordinate.z - entry) / u_lights[light].shadow.z;
}

// Distance in metres that light travels inside the subject, to a point `shrink` metres below the
// surface or to the surface itself, whichever is longer. Below an overhang, the shrunken point may
// lie outside the subject on the lamp's side. It would then receive undimmed light that cannot
// reach the surface.
float thicknessOf(int light, vec3 position, vec3 normal, float shrink) {
  vec4 below = shadowCoordinate(u_lights[light], position - shrink * normal);
  vec4 at = shadowCoordinate(u_lights[light], position);
  return max(max(depthBelowEntry(light, below), depthBelowEntry(light, at)), 0.0);
}
