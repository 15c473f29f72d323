// SPDX-License-Identifier: Apache-2.0
#include "common_scatter.glsl"
#include "common_shadow.glsl"
#include "common_specular.glsl"
#include "common_diffusion.glsl"
#include "common_surface_frag.glsl"

// The scene pass of the skin pipeline: light on skin apart from all other light, and what the later
// passes need to know of the surface.
//
// MATERIAL       MATERIAL_SKIN, _CLOTH, _EYE, _HAIR or _OTHER
// TRANSLUCENCY   1: light goes through thin parts
// WIDEN          1: gloss is wider where the pixel covers many slopes
// WRINKLE_LOOKS  1: some wrinkle map has a colour or a cavity
// HAS_THICKNESS  1: the material has a texture of its flesh's thickness
// CONSERVE       1: diffuse light is what the specular leaves
// PREINTEGRATED  1: scattering by table, here and now
// RING_SIZE, MAX_CURVATURE  texels of the table's side; its last row, per mm

layout(binding = 9) uniform sampler2D u_ring_table;  // render/subsurface_kernel.h: PreintegratedTable

#if HAS_THICKNESS
layout(binding = 11) uniform sampler2D u_thickness_map;  // green, as in glTF
#endif

layout(location = 0) out vec4 f_irradiance;  // rgb: light on skin times albedo^mix; a: metres
                                             // behind the focus, FAR_AWAY where there is no skin
layout(location = 1) out vec4 f_radiance;    // rgb: all light that does not scatter; a: the share
                                             // of it that comes from the sky
layout(location = 2) out vec4 f_albedo;      // rgb: albedo^(1 - mix) of skin; a: the share of
                                             // f_irradiance that comes from the sky
layout(location = 3) out vec4 f_normal;      // xyz: 0.5 n + 0.5, model space
layout(location = 4) out float f_depth;      // metres along the camera's axis

struct Lit {
  vec3 direct;    // diffuse, of lamps
  vec3 through;   // of lamps, through the subject
  vec3 specular;  // of lamps
  vec3 visible;   // of the lamps, one a channel: for the view `shadow`
};

struct Facet {
  vec3 normal;      // unit; of the shading, with wrinkles
  vec3 geometric;   // unit
  vec3 toCamera;    // unit
  float m;          // Beckmann's
  float curvature;  // 1 / mm
  float thickness;  // metres of flesh that light meets at least
};

// Charlie (Estevez and Kulla 2017) with Neubelt's visibility, times pi: the fuzz of cloth.
float sheen(vec3 normal, vec3 toLight, vec3 toCamera) {
  const float inverse = 1.0 / 0.45;
  vec3 h = normalizeOrZero(toLight + toCamera);
  float cosine = saturate(dot(normal, h));
  float sine2 = max(1.0 - cosine * cosine, 1e-4);
  float lobe = (2.0 + inverse) * pow(sine2, 0.5 * inverse) * 0.5;
  float nl = saturate(dot(normal, toLight));
  float nv = saturate(dot(normal, toCamera));
  return lobe / (4.0 * max(nl + nv - nl * nv, 1e-3));
}

// Metres of flesh that light meets at least, wherever it comes from.
float thickness() {
#if HAS_THICKNESS
  return u_thickness * texture(u_thickness_map, v_uv).g;
#else
  return u_thickness;
#endif
}

// What lamp `i` adds.
void addLamp(int i, Facet facet, inout Lit lit) {
  Arrival arrival = arrivalOf(u_lights[i], v_position);
  float cosine = dot(facet.normal, arrival.toLight);
  float seen = 1.0;
  if (i < SHADOW_LAMPS) {
    seen = shadowOf(i, v_position, facet.geometric, arrival.toLight, gl_FragCoord.xy);
  }
  lit.visible[i] = seen * saturate(sign(cosine));
  float facing = saturate(cosine);
  vec3 irradiance = arrival.radiance * (facing * seen);
  float leaves = 1.0;
#if CONSERVE
  leaves = 1.0 - saturate(u_gloss.x * specularAlbedo(facing, facet.m, u_gloss.z, u_f0));
#endif
#if PREINTEGRATED
  vec2 cell = vec2(cosine * 0.5 + 0.5, facet.curvature / MAX_CURVATURE);
  vec2 place = (cell * (RING_SIZE - 1.0) + 0.5) / RING_SIZE;
  vec3 ring = textureLod(u_ring_table, place, 0.0).rgb;
  lit.direct += arrival.radiance * ring * (seen * leaves);
#else
  lit.direct += irradiance * leaves;
#endif
  lit.specular += irradiance * (u_gloss.x * kelemen(facet.normal, arrival.toLight, facet.toCamera,
                                                    facet.m, u_gloss.z, u_f0));
#if MATERIAL == MATERIAL_CLOTH
  lit.specular += irradiance * (u_sheen * sheen(facet.normal, arrival.toLight, facet.toCamera));
#endif
#if TRANSLUCENCY
  if (i >= SHADOW_LAMPS) return;  // no map to measure in
  float behind = saturate(0.3 - dot(facet.geometric, arrival.toLight));
  int sides = behind > 0.0 ? 1 : 0;  // a loop: groups of pixels that face the lamp leave it
  for (int side = 0; side < sides; ++side) {
    float metres = thicknessOf(i, v_position, facet.geometric, u_translucency.z);
    lit.through += arrival.radiance * (u_translucency.x * behind) *
                   transmittance(1000.0 * u_translucency.y * max(metres, facet.thickness));
  }
#endif
}

// Lamp by lamp and not in a loop: a loop around loops is not unrolled, and what is looked up by its
// counter is looked up for every pixel by itself.
Lit lightSurface(Facet facet) {
  Lit lit = Lit(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  addLamp(0, facet, lit);
  addLamp(1, facet, lit);
  addLamp(2, facet, lit);
  return lit;
}

float share(vec3 part, vec3 whole) {
  return saturate(luminance(part) / max(luminance(whole), 1e-6));
}

vec3 materialColour() {
#if MATERIAL == MATERIAL_SKIN
  return vec3(1.0, 0.0, 0.0);
#elif MATERIAL == MATERIAL_CLOTH
  return vec3(0.0, 0.0, 1.0);
#elif MATERIAL == MATERIAL_EYE
  return vec3(1.0);
#elif MATERIAL == MATERIAL_HAIR
  return vec3(0.0, 1.0, 0.0);
#else
  return vec3(0.5);
#endif
}

// 1 / radius of the surface, per millimetre.
float curvatureOf(vec3 normal) {
  return length(fwidth(normal)) / max(1000.0 * length(fwidth(v_position)), 1e-6);
}

void main() {
  vec4 masks[MASK_LAYERS];
  vec4 dynamicMasks[MAP_SLOTS];
  vec4 base = beginSurface(masks, dynamicMasks);
  vec3 geometric = normalizeOrZero(gl_FrontFacing ? v_normal : -v_normal);
  float variance;
  vec3 normal = surfaceNormal(masks, dynamicMasks, variance);
  vec3 fromCamera = v_position - u_camera_position.xyz;
  vec3 toCamera = -normalize(fromCamera);
  float metres = dot(fromCamera, u_camera_forward.xyz);
  float rough = roughness();
  float m = u_gloss.y * rough * rough;
#if WIDEN
  m = sqrt(m * m + 2.0 * variance);  // Beckmann's m^2 is twice the variance of slopes
#endif
  m = clamp(m, SMALLEST_M, 1.0);
  float nv = saturate(dot(normal, toCamera));

  Lit lit = lightSurface(
      Facet(normal, geometric, toCamera, m, curvatureOf(geometric), thickness()));
  float reflects = saturate(u_gloss.x * specularAlbedo(nv, m, u_gloss.z, u_f0));
  float leaves = CONSERVE == 1 ? 1.0 - reflects : 1.0;
  float open = cavity(base.rgb);
  float crease = 1.0;
#if WRINKLE_LOOKS && (WRINKLE_TEXTURE || WRINKLE_DYNAMIC)
  vec4 look = wrinkleLook(v_uv, masks, dynamicMasks, u_wrinkle_maps.xy);
  base.rgb *= look.rgb;
  crease = look.a;
#endif
  vec3 sky = skyIrradiance(normal) * crease;
  vec3 tint = vec3(open * crease);
#if MATERIAL == MATERIAL_HAIR
  // Most of what hair sends back went through it: it has hair's colour, and little is white.
  tint *= mix(vec3(0.25), 4.0 * base.rgb, 0.75);
#endif
  vec3 skySpecular = skyRadiance(reflect(-toCamera, normal)) * (reflects * tint);
  vec3 specular = lit.specular * tint;
  vec3 diffuse = leaves * (lit.direct + sky) + lit.through;
  float skyShare = share(leaves * sky, diffuse);

#if MATERIAL == MATERIAL_SKIN && VIEW == VIEW_FINAL
  vec3 albedo = max(base.rgb, vec3(1e-4));
  vec3 before = pow(albedo, vec3(u_gloss.w));
  f_irradiance = vec4(diffuse * before, metres - u_camera_forward.w);
  f_albedo = vec4(albedo / before, skyShare);
  f_radiance = vec4(specular + skySpecular, share(skySpecular, specular + skySpecular));
#else
  vec3 colour = base.rgb * diffuse + specular + skySpecular;
  f_irradiance = vec4(0.0, 0.0, 0.0, FAR_AWAY);
  f_albedo = vec4(0.0);
  f_radiance = vec4(colour, share(base.rgb * leaves * sky + skySpecular, colour));
#endif
#if VIEW == VIEW_SPECULAR
  f_radiance = vec4(specular + skySpecular, 0.0);
#elif VIEW == VIEW_TRANSLUCENCY
  f_radiance = vec4(base.rgb * lit.through, 0.0);
#elif VIEW == VIEW_SHADOW
  f_radiance = vec4(lit.visible, 0.0);
#elif VIEW == VIEW_ALBEDO
  f_radiance = vec4(base.rgb, 0.0);
#elif VIEW == VIEW_MATERIAL
  f_radiance = vec4(materialColour(), 0.0);
#endif
  f_normal = vec4(normal * 0.5 + 0.5, 1.0);
  f_depth = metres;
}
