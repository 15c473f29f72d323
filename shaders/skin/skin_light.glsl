// SPDX-License-Identifier: Apache-2.0
#include "skin/diffusion.glsl"
#include "scene/facet.glsl"
#include "skin/materials.glsl"
#include "skin/scatter.glsl"
#include "shadow/shadow.glsl"
#include "skin/specular.glsl"

// The light of the skin pipeline on a facet, and what of it goes into which target.
//
// TRANSLUCENCY   1: light goes through thin skin
// CONSERVE       1: diffuse light is what the specular leaves
// PREINTEGRATED  1: skin scatters by table, here and now
// RING_SIZE, MAX_CURVATURE  texels of the table's side; its last row, per mm
// MATERIALS      1: all materials come through one program; 0: MATERIAL is the only one
// Where there are several, what is one material's alone stands in a loop that others leave at once.

#if PREINTEGRATED
layout(binding = 9) uniform sampler2D u_ring_table;  // render/skin/subsurface_kernel.h: PreintegratedTable
#endif

struct Lit {
  vec3 direct;       // diffuse, of lamps
  vec3 sky;          // diffuse, of the sky
  vec3 through;      // of lamps, through the subject
  vec3 specular;     // of lamps
  vec3 skySpecular;
  vec3 visible;      // of the lamps, one a channel: for the view `shadow`
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

// Share of light from `cosine` that the fuzz reflects in all, [0, 1]: a fit to 0.02.
float sheenAlbedo(float cosine) { return 0.78 - 0.7 * sqrt(cosine); }

// Share of a lamp's light that a surface of bumps sends on: none hides another by its normal alone,
// and where light grazes those that face it would blaze, up to a hard edge (Estevez, Lecocq and Stein
// 2019, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem").
float bumpShadow(Facet facet, vec3 toLight) {
  float bump = saturate(dot(facet.geometric, facet.normal));
  float cosine = saturate(dot(facet.geometric, toLight));
  float steep = min(0.125 * (1.0 / max(bump * bump, 1e-4) - 1.0), 1.0);
  return 2.0 / (1.0 + sqrt(1.0 + steep * (1.0 / max(cosine * cosine, 1e-4) - 1.0)));
}

// Diffuse light of a lamp without its shadow, by table where that scatters.
vec3 diffuseOf(Facet facet, Arrival arrival, float cosine) {
  vec3 facing = vec3(saturate(cosine));
#if PREINTEGRATED
  vec2 cell = vec2(cosine * 0.5 + 0.5, facet.curvature / MAX_CURVATURE);
  vec2 place = (cell * (RING_SIZE - 1.0) + 0.5) / RING_SIZE;
  vec3 ring = textureLod(u_ring_table, place, 0.0).rgb;
  facing = facet.kind == MATERIAL_SKIN ? ring : facing;
#endif
  return arrival.radiance * facing;
}

// What lamp `i` adds.
void addLamp(int i, Facet facet, vec3 toCamera, inout Lit lit) {
  Arrival arrival = arrivalOf(u_lights[i], facet.position);
  float f0 = reflectanceOf(facet.kind);
  float cosine = dot(facet.normal, arrival.toLight);
  float seen = 1.0;
  if (i < SHADOW_LAMPS) {
    // Skin scatters the noise of turned discs away; elsewhere it would be a screen of dots.
    vec2 turned = facet.kind == MATERIAL_SKIN ? gl_FragCoord.xy : vec2(0.0);
    seen = shadowOf(i, facet.position, facet.geometric, arrival.toLight, turned);
  }
  lit.visible[i] = seen * saturate(sign(cosine));
  if (facet.kind != MATERIAL_HAIR) seen *= bumpShadow(facet, arrival.toLight);
  float facing = saturate(cosine);
  vec3 irradiance = arrival.radiance * (facing * seen);
  float leaves = 1.0;
#if CONSERVE
  leaves = 1.0 - saturate(u_gloss.x * specularAlbedo(facing, facet.m, u_gloss.z, f0));
#endif
  float through = 1.0;  // what the fuzz lets through to what is under it
#if MATERIALS || MATERIAL == MATERIAL_CLOTH
  int fuzz = facet.kind == MATERIAL_CLOTH ? 1 : 0;
  for (int k = 0; k < fuzz; ++k) {
    float strength = sheenOf(facet.kind);
    lit.specular += irradiance * (strength * sheen(facet.normal, arrival.toLight, toCamera));
    through -= strength * sheenAlbedo(facing);
  }
#endif
  lit.direct += diffuseOf(facet, arrival, cosine) * (seen * leaves * through);
  lit.specular += irradiance * (u_gloss.x * through *
                                kelemen(facet.normal, arrival.toLight, toCamera, facet.m,
                                        u_gloss.z, f0));
#if TRANSLUCENCY
  if (i >= SHADOW_LAMPS) return;  // no map to measure in
  float behind = saturate(0.3 - dot(facet.geometric, arrival.toLight));
  int sides = behind > 0.0 && facet.kind == MATERIAL_SKIN ? 1 : 0;
  for (int side = 0; side < sides; ++side) {
    float metres = thicknessOf(i, facet.position, facet.geometric, u_translucency.z);
    lit.through += arrival.radiance * (u_translucency.x * behind) *
                   transmittance(1000.0 * u_translucency.y * max(metres, facet.thickness));
  }
#endif
}

// Lamp by lamp and not in a loop: a loop around loops is not unrolled, and what is looked up by its
// counter is looked up for every pixel by itself.
Lit lightFacet(Facet facet) {
  Lit lit = Lit(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  vec3 toCamera = normalize(u_camera_position.xyz - facet.position);
  addLamp(0, facet, toCamera, lit);
  addLamp(1, facet, toCamera, lit);
  addLamp(2, facet, toCamera, lit);
  float nv = saturate(dot(facet.normal, toCamera));
  float f0 = reflectanceOf(facet.kind);
  float reflects = saturate(u_gloss.x * specularAlbedo(nv, facet.m, u_gloss.z, f0));
  float leaves = CONSERVE == 1 ? 1.0 - reflects : 1.0;
  vec3 tint = vec3(facet.open * facet.crease);
  // Most of what hair sends back went through it: it has hair's colour, and little is white.
  vec3 strand = min(mix(vec3(0.25), 4.0 * facet.colour, 0.75), vec3(1.0));
  tint *= facet.kind == MATERIAL_HAIR ? strand : vec3(1.0);
  lit.direct *= leaves;
  lit.sky = skyIrradiance(facet.normal) * (facet.crease * leaves);
  lit.specular *= tint;
  lit.skySpecular = skyRadiance(reflect(-toCamera, facet.normal)) * (reflects * tint);
  return lit;
}

struct Leaving {
  vec4 irradiance;  // rgb: light on skin times albedo^mix; a: metres behind the focus, FAR_AWAY
                    // where there is no skin
  vec3 radiance;    // all light that does not scatter
  vec3 albedo;      // albedo^(1 - mix) of skin; of the rest, where no light scatters, its colour
};

// `metres`: along the camera's axis.
Leaving leavingLight(Facet facet, Lit lit, float metres) {
  vec3 diffuse = lit.direct + lit.sky + lit.through;
  vec3 specular = lit.specular + lit.skySpecular;
  Leaving leaving;
#if VIEW == VIEW_FINAL
  vec3 albedo = max(facet.colour, vec3(1e-4));
  vec3 before = pow(albedo, vec3(u_gloss.w));
  bool skin = facet.kind == MATERIAL_SKIN;
  leaving.irradiance = skin ? vec4(diffuse * before, metres - u_camera_forward.w)
                         : vec4(0.0, 0.0, 0.0, FAR_AWAY);
  leaving.radiance = specular + (skin ? vec3(0.0) : facet.colour * diffuse);
  leaving.albedo = skin ? albedo / before : facet.colour;
#else
  leaving = Leaving(vec4(0.0, 0.0, 0.0, FAR_AWAY), vec3(0.0), vec3(0.0));
#if VIEW == VIEW_SPECULAR
  leaving.radiance = specular;
#elif VIEW == VIEW_TRANSLUCENCY
  leaving.radiance = facet.colour * lit.through;
#elif VIEW == VIEW_SHADOW
  leaving.radiance = lit.visible;
#elif VIEW == VIEW_ALBEDO
  leaving.radiance = facet.colour;
#elif VIEW == VIEW_MATERIAL
  leaving.radiance = materialColour(facet.kind);
#endif
#endif
  return leaving;
}
