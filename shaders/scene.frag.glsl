// SPDX-License-Identifier: Apache-2.0
#include "common_lighting.glsl"
#include "common_wrinkles_frag.glsl"

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec4 v_tangent;
layout(location = 3) in vec2 v_uv;
#if VIEW == VIEW_WIREFRAME
layout(location = 4) in vec3 v_barycentric;
#endif
#if WRINKLE_DYNAMIC
layout(location = 5) in vec4 v_dynamic_masks[MAP_SLOTS];
#endif

// Mirrors MaterialBlock in render/gpu_character.cpp.
layout(std140, binding = 1) uniform Material {
  vec4 u_base_colour;      // linear
  float u_roughness;       // [0, 1]
  float u_specular;
  float u_alpha_cutoff;
  float u_cavity_albedo;   // see cavity(); 0: none
};

// One row a mask layer's channel: the colour of its region in the view `mask_texture`.
layout(std430, binding = 2) readonly buffer MaskPalette { vec4 u_mask_palette[]; };

layout(binding = 0) uniform sampler2D u_base_colour_map;        // sRGB
layout(binding = 1) uniform sampler2D u_base_derivatives;       // RG, n.xy / n.z
layout(binding = 4) uniform sampler2D u_roughness_map;          // green, as in glTF

layout(location = 0) out vec4 f_colour;  // linear; a: 1

vec4 baseColour() {
#if HAS_BASE_COLOUR
  return u_base_colour * texture(u_base_colour_map, v_uv);
#else
  return u_base_colour;
#endif
}

float roughness() {
#if HAS_ROUGHNESS
  return u_roughness * texture(u_roughness_map, v_uv).g;
#else
  return u_roughness;
#endif
}

void sampleMasks(out vec4 masks[MASK_LAYERS]) {
  for (int layer = 0; layer < MASK_LAYERS; ++layer) {
#if WRINKLE_TEXTURE || VIEW == VIEW_MASK_TEXTURE
    masks[layer] = texture(u_masks, vec3(v_uv, float(layer)));
#else
    masks[layer] = vec4(0.0);
#endif
  }
}

// Unit, model space.
vec3 surfaceNormal(vec4 masks[MASK_LAYERS], vec4 dynamicMasks[MAP_SLOTS]) {
#if HAS_BASE_NORMAL
  vec2 base = texture(u_base_derivatives, v_uv).rg;
#else
  vec2 base = vec2(0.0);
#endif
#if WRINKLE_TEXTURE || WRINKLE_DYNAMIC
  vec3 n = wrinkledNormal(base, v_uv, masks, dynamicMasks);
#else
  vec3 n = normalFromDerivative(base);
#endif
  vec3 normal = tangentToModel(n, v_normal, v_tangent);
  return gl_FrontFacing ? normal : -normal;
}

// Share of the specular light that gets in and out again, [0, 1]. No skin reflects less than 2%:
// where the base colour is darker, it is painted hollow (mouth, nostrils), which nothing shadows.
float cavity(vec3 albedo) {
  return u_cavity_albedo > 0.0 ? saturate(albedo.g / u_cavity_albedo) : 1.0;
}

// Beckmann's roughness squared to a Blinn-Phong exponent: n = 2 / alpha^2 - 2, alpha = roughness^2.
float exponentOf(float rough) {
  float alpha = max(rough * rough, 0.04);
  return max(2.0 / (alpha * alpha) - 2.0, 1.0);
}

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
// 1 on an edge, 0 away from it; lines about a pixel wide whatever the triangle's size.
float edge() {
  vec3 width = fwidth(v_barycentric);
  vec3 near = smoothstep(vec3(0.0), 0.9 * width, v_barycentric);
  return 1.0 - min(near.x, min(near.y, near.z));
}
#endif

void main() {
  vec4 base = baseColour();
#if ALPHA_TEST
  if (base.a < u_alpha_cutoff) discard;
#endif
  vec4 masks[MASK_LAYERS];
  sampleMasks(masks);
#if WRINKLE_DYNAMIC
  vec4 dynamicMasks[MAP_SLOTS] = v_dynamic_masks;
#else
  vec4 dynamicMasks[MAP_SLOTS];
#endif

#if VIEW == VIEW_MASK_TEXTURE
  f_colour = vec4(maskColour(masks), 1.0);
#elif VIEW == VIEW_MASK_DYNAMIC
#if WRINKLE_DYNAMIC
  f_colour = vec4(wrinkleColour(masks, dynamicMasks), 1.0);
#else
  f_colour = vec4(0.0, 0.0, 0.0, 1.0);
#endif
#else
  vec3 normal = surfaceNormal(masks, dynamicMasks);
#if VIEW == VIEW_NORMAL
  f_colour = vec4(normal * 0.5 + 0.5, 1.0);
#else
  Surface surface = Surface(base.rgb, normal, exponentOf(roughness()),
                            u_specular * cavity(base.rgb));
#if VIEW != VIEW_FINAL
  surface.albedo = vec3(0.35);  // neutral grey under the colours and lines
#endif
  vec3 radiance = shade(surface, normalize(u_camera_position.xyz - v_position));
#if VIEW == VIEW_WEIGHTS && (WRINKLE_TEXTURE || WRINKLE_DYNAMIC)
  vec3 colour = wrinkleColour(masks, dynamicMasks);
  float strength = saturate(max(colour.r, max(colour.g, colour.b)));
  float grey = dot(radiance, vec3(0.2126, 0.7152, 0.0722));
  radiance = mix(radiance, colour * (0.25 + 1.5 * grey), strength);
#elif VIEW == VIEW_WIREFRAME
  radiance = mix(radiance * 0.35, vec3(0.75, 0.85, 1.0), edge());
#endif
  f_colour = vec4(radiance, 1.0);
#endif
#endif
}
