// SPDX-License-Identifier: Apache-2.0
#include "wrinkles/wrinkles_frag.glsl"

// Material and normal of a fragment, before lighting. Inputs are the outputs of
// scene/scene.vert.glsl.

// The level of a texture, as a last argument of texture().
#if MOTION
#include "scene/motion.glsl"
#define DETAIL , u_detail.x
#else
#define DETAIL
#endif

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec4 v_tangent;
layout(location = 3) in vec2 v_uv;
#if VIEW == VIEW_WIREFRAME
layout(location = 4) in vec3 v_barycentric;
#endif
#if CROWD
layout(location = 5) flat in uint v_subject;
#endif
#if WRINKLE_DYNAMIC
layout(location = 6) in vec4 v_dynamic_masks[MAP_SLOTS];
#endif

// Mirrors MaterialBlock of render/scene/gpu_character.h.
layout(std140, binding = 1) uniform Material {
  vec4 u_base_colour;      // linear
  float u_roughness;       // [0, 1]
  float u_specular;
  float u_alpha_cutoff;
  float u_cavity_albedo;   // see cavity(); 0: no painted hollows
  float u_thickness;       // metres of flesh that light passes through, at least
  vec4 u_texture_uv;       // scale and offset from v_uv to the UVs of the material's own textures
  vec4 u_emission;         // rgb: light that the surface sends out, linear
};

layout(binding = 0) uniform sampler2D u_base_colour_map;        // sRGB
layout(binding = 1) uniform sampler2D u_base_derivatives;       // n.xy / n.z, and their squares
layout(binding = 4) uniform sampler2D u_roughness_map;          // green, as in glTF
#if HAS_EMISSION
layout(binding = 14) uniform sampler2D u_emission_map;          // sRGB
#endif

// UVs of the material's own textures. Masks and wrinkle maps use v_uv.
vec2 textureUv() { return v_uv * u_texture_uv.xy + u_texture_uv.zw; }

// Base colour, linear; a: opacity.
vec4 baseColour() {
#if HAS_BASE_COLOUR
  return u_base_colour * texture(u_base_colour_map, textureUv() DETAIL);
#else
  return u_base_colour;
#endif
}

// Light that the surface sends out, linear.
vec3 emission() {
#if HAS_EMISSION
  return u_emission.rgb * texture(u_emission_map, textureUv()).rgb;
#elif EMITS
  return u_emission.rgb;
#else
  return vec3(0.0);
#endif
}

// Roughness, [0, 1].
float roughness() {
#if HAS_ROUGHNESS
  return u_roughness * texture(u_roughness_map, textureUv() DETAIL).g;
#else
  return u_roughness;
#endif
}

// Samples the masks of the layers that this surface needs; the others are 0.
void sampleMasks(out vec4 masks[MASK_LAYERS]) {
  for (int layer = 0; layer < MASK_LAYERS; ++layer) {
    masks[layer] = vec4(0.0);
#if WRINKLE_TEXTURE || VIEW == VIEW_MASK_TEXTURE
    bool isUsed = (MASK_BITS >> min(layer, 31) & 1) != 0;
    if (isUsed) masks[layer] = texture(u_masks, vec3(v_uv, float(layer)));
#endif
  }
}

#if ALPHA_TEST
// The bit mask of the pixel's samples that a cut-out keeps. Where texels are larger than pixels,
// the cut-off's edge through the pixel determines the number of samples. Where a pixel covers many
// texels, their mean alpha does. Different triangles keep different samples, so that overlapping
// layers do not all keep the same ones.
int samplesLeft(float alpha) {
  if (gl_NumSamples == 1) return alpha < u_alpha_cutoff ? 0 : 1;
  float line = clamp((alpha - u_alpha_cutoff) / max(fwidth(alpha), 1e-4) + 0.5, 0.0, 1.0);
#if HAS_BASE_COLOUR
  // Not textureQueryLod(), which returns 0 for every distance on some drivers.
  vec2 texels = vec2(textureSize(u_base_colour_map, 0));
  vec2 across = dFdx(textureUv()) * texels;
  vec2 along = dFdy(textureUv()) * texels;
  float level = 0.5 * log2(max(max(dot(across, across), dot(along, along)), 1e-8));
  line = mix(line, alpha, clamp(level, 0.0, 1.0));
#endif
  int count = int(line * float(gl_NumSamples) + 0.5);
  int bits = ((1 << count) - 1) << (gl_PrimitiveID % gl_NumSamples);
  return (bits | bits >> gl_NumSamples) & ((1 << gl_NumSamples) - 1);
}
#endif

// Starts every fragment: returns the base colour, reads all masks, and discards the fragment where
// its texture is cut out.
vec4 beginSurface(out vec4 masks[MASK_LAYERS], out vec4 dynamicMasks[MAP_SLOTS]) {
  vec4 base = baseColour();
#if ALPHA_TEST
  int samples = samplesLeft(base.a);
  if (samples == 0) discard;
  if (gl_NumSamples > 1) gl_SampleMask[0] = samples;
#endif
#if CROWD
  currentSubject = v_subject;
#endif
  sampleMasks(masks);
#if WRINKLE_DYNAMIC
  dynamicMasks = v_dynamic_masks;
#else
  for (int slot = 0; slot < MAP_SLOTS; ++slot) dynamicMasks[slot] = vec4(0.0);
#endif
  return base;
}

// Returns true if v_normal belongs to the visible side. Hair cards use the normals of the hair's
// volume, which has one side only.
bool facesCamera() { return MATERIAL == MATERIAL_HAIR || gl_FrontFacing; }

// Unit shading normal, model space. `variance`: of the slopes within the pixel.
vec3 surfaceNormal(vec4 masks[MASK_LAYERS], vec4 dynamicMasks[MAP_SLOTS], out float variance) {
#if HAS_BASE_NORMAL
  vec3 base = slopeOf(texture(u_base_derivatives, textureUv() DETAIL));
#else
  vec3 base = vec3(0.0);
#endif
  variance = base.z;
#if WRINKLE_TEXTURE || WRINKLE_DYNAMIC
  vec3 n = wrinkledNormal(base.xy, v_uv, masks, dynamicMasks, variance);
#else
  vec3 n = normalFromDerivative(base.xy);
#endif
#if STRETCH
  n = normalFromDerivative(stretchedSlope(n.xy / max(n.z, 1e-3), v_tangent));
#endif
  vec3 normal = tangentToModel(n, v_normal, v_tangent);
  return facesCamera() ? normal : -normal;
}

// Share of specular light that enters and leaves the surface, [0, 1]. Real skin reflects at least
// 2%. A darker base colour therefore marks a painted hollow (mouth, nostrils), which no shadow
// darkens.
float cavity(vec3 albedo) {
  return u_cavity_albedo > 0.0 ? saturate(albedo.g / u_cavity_albedo) : 1.0;
}
