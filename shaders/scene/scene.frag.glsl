// SPDX-License-Identifier: Apache-2.0
#include "scene/lighting.glsl"
#include "scene/surface_frag.glsl"

// Per channel of each mask layer: the colour of its region in the view `mask_texture`.
layout(std430, binding = 2) readonly buffer MaskPalette { vec4 u_mask_palette[]; };

layout(location = 0) out vec4 f_colour;  // linear; a: 1

// Converts roughness to a Blinn-Phong exponent, at least 1: n = 2 / alpha^2 - 2, alpha =
// roughness^2.
float exponentOf(float rough) {
  float alpha = max(rough * rough, 0.04);
  return max(2.0 / (alpha * alpha) - 2.0, 1.0);
}

// Mixes the regions' colours by their masks.
vec3 maskColour(vec4 masks[MASK_LAYERS]) {
  vec3 colour = vec3(0.0);
  for (int layer = 0; layer < MASK_LAYERS; ++layer) {
    for (int channel = 0; channel < 4; ++channel) {
      colour += masks[layer][channel] * u_mask_palette[layer * 4 + channel].rgb;
    }
  }
  return colour;
}

#if VIEW == VIEW_WIREFRAME
// 1 on an edge of the triangle, 0 away from it. Lines are about one pixel wide at any triangle
// size.
float edge() {
  vec3 width = fwidth(v_barycentric);
  vec3 near = smoothstep(vec3(0.0), 0.9 * width, v_barycentric);
  return 1.0 - min(near.x, min(near.y, near.z));
}
#endif

void main() {
  vec4 masks[MASK_LAYERS];
  vec4 dynamicMasks[MAP_SLOTS];
  vec4 base = beginSurface(masks, dynamicMasks);

#if VIEW == VIEW_MASK_TEXTURE
  f_colour = vec4(maskColour(masks), 1.0);
#elif VIEW == VIEW_MASK_DYNAMIC
#if WRINKLE_DYNAMIC
  f_colour = vec4(wrinkleColour(masks, dynamicMasks), 1.0);
#else
  f_colour = vec4(0.0, 0.0, 0.0, 1.0);
#endif
#else
  float variance;
  vec3 normal = surfaceNormal(masks, dynamicMasks, variance);
#if VIEW == VIEW_NORMAL
  f_colour = vec4(normal * 0.5 + 0.5, 1.0);
#else
  Surface surface = Surface(base.rgb, normal, exponentOf(roughness()),
                            u_specular * cavity(base.rgb));
#if VIEW != VIEW_FINAL
  surface.albedo = vec3(0.35);  // neutral grey under the colours and lines
#endif
  vec3 radiance = shade(surface, v_position, normalize(u_camera_position.xyz - v_position));
#if VIEW == VIEW_WEIGHTS && (WRINKLE_TEXTURE || WRINKLE_DYNAMIC)
  vec3 colour = wrinkleColour(masks, dynamicMasks);
  float strength = saturate(max(colour.r, max(colour.g, colour.b)));
  float grey = luminance(radiance);
  radiance = mix(radiance, colour * (0.25 + 1.5 * grey), strength);
#elif VIEW == VIEW_WIREFRAME
  radiance = mix(radiance * 0.35, vec3(0.75, 0.85, 1.0), edge());
#elif VIEW == VIEW_FINAL && EMITS
  radiance += emission();
#endif
  f_colour = vec4(radiance, 1.0);
#endif
#endif
}
