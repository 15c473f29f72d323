// SPDX-License-Identifier: Apache-2.0
#include "skin/diffusion.glsl"
#include "scene/facet.glsl"
#include "skin/materials.glsl"
#include "skin/scatter.glsl"
#include "shadow/shadow.glsl"
#include "skin/specular.glsl"

// Lights a facet for the skin pipeline and splits the light into the pipeline's targets.
//
// TRANSLUCENCY   1: light passes through thin skin
// CONSERVE       1: the diffuse light is reduced by the reflected light
// PREINTEGRATED  1: skin scatters here, by look-up table
// RING_SIZE      texels per side of that table
// MAX_CURVATURE  curvature of its last row, per mm
// MATERIALS      1: one program for all materials; 0: MATERIAL is the only one
//
// With MATERIALS, code for a single material is inside a loop, which other materials skip.

#if PREINTEGRATED
layout(binding = 9) uniform sampler2D u_ring_table;  // PreintegratedTable() of
                                                     // render/skin/subsurface_kernel.h
#endif

struct Lit {
  vec3 direct;       // diffuse, from lamps
  vec3 sky;          // diffuse, from the sky
  vec3 through;      // from lamps, through the subject
  vec3 specular;     // from lamps
  vec3 skySpecular;
  vec3 visible;      // visibility of the lamps, one per channel, for the view `shadow`
};

// Sheen of cloth: the Charlie distribution (Estevez and Kulla 2017) with Neubelt's visibility,
// times pi. Directions are unit.
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

// Share of light from `cosine` that the sheen reflects in total, [0, 1]; a fit within 0.02.
float sheenAlbedo(float cosine) { return 0.78 - 0.7 * sqrt(cosine); }

// Shadowing of bumps, [0, 1] (Estevez, Lecocq and Stein 2019, "A Microfacet-Based Shadowing
// Function to Solve the Bump Terminator Problem"). Without it, bumps would not shade each other at
// grazing light, and those that face the light would be overbright up to a hard edge.
float bumpShadow(Facet facet, vec3 toLight) {
  float bump = saturate(dot(facet.geometric, facet.normal));
  float cosine = saturate(dot(facet.geometric, toLight));
  float steep = min(0.125 * (1.0 / max(bump * bump, 1e-4) - 1.0), 1.0);
  return 2.0 / (1.0 + sqrt(1.0 + steep * (1.0 / max(cosine * cosine, 1e-4) - 1.0)));
}

// Diffuse light of a lamp without its shadow. Looks up preintegrated scattering on skin.
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

// Adds the light of lamp `i`. `mapped`: the facet's position in the shadow maps. `toCamera`: unit.
void addLamp(int i, Facet facet, vec3 mapped, vec3 toCamera, inout Lit lit) {
  Arrival arrival = arrivalOf(u_lights[i], facet.position);
  float f0 = reflectanceOf(facet.kind);
  float cosine = dot(facet.normal, arrival.toLight);
  float seen = 1.0;
  if (i < SHADOW_LAMPS) {
    // Noise from rotated discs is invisible on skin, which scatters it. Other materials would show
    // a dot pattern, so their discs are not rotated.
    vec2 turned = facet.kind == MATERIAL_SKIN ? gl_FragCoord.xy : vec2(0.0);
    seen = shadowOf(i, mapped, facet.geometric, arrival.toLight, turned);
  }
  lit.visible[i] = seen * saturate(sign(cosine));
  if (facet.kind != MATERIAL_HAIR) seen *= bumpShadow(facet, arrival.toLight);
  float facing = saturate(cosine);
  vec3 irradiance = arrival.radiance * (facing * seen);
  float leaves = 1.0;
#if CONSERVE
  leaves = 1.0 - saturate(u_gloss.x * specularAlbedo(facing, facet.m, u_gloss.z, f0));
#endif
  float through = 1.0;  // share of light that passes the sheen
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
  if (i >= SHADOW_LAMPS) return;  // no shadow map to measure the thickness in
  float behind = saturate(0.3 - dot(facet.geometric, arrival.toLight));
  int sides = behind > 0.0 && facet.kind == MATERIAL_SKIN ? 1 : 0;
  for (int side = 0; side < sides; ++side) {
    float metres = thicknessOf(i, mapped, facet.geometric, u_translucency.z);
    lit.through += arrival.radiance * (u_translucency.x * behind) *
                   transmittance(1000.0 * u_translucency.y * max(metres, facet.thickness));
  }
#endif
}

// Lights a facet. `mapped`: its position when the shadow maps were drawn. The lamps are unrolled by
// hand, because compilers do not unroll a loop around loops, and indexing the lamps by its counter
// would then be done per pixel.
Lit lightFacet(Facet facet, vec3 mapped) {
  Lit lit = Lit(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  vec3 toCamera = normalize(u_camera_position.xyz - facet.position);
  addLamp(0, facet, mapped, toCamera, lit);
  addLamp(1, facet, mapped, toCamera, lit);
  addLamp(2, facet, mapped, toCamera, lit);
  float nv = saturate(dot(facet.normal, toCamera));
  float f0 = reflectanceOf(facet.kind);
  float reflects = saturate(u_gloss.x * specularAlbedo(nv, facet.m, u_gloss.z, f0));
  float leaves = CONSERVE == 1 ? 1.0 - reflects : 1.0;
  vec3 tint = vec3(facet.open * facet.crease);
  // Most light from hair has passed through strands. It has the hair's colour, with little white.
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
                    // without skin
  vec3 radiance;    // all light that does not scatter
  vec3 albedo;      // skin: albedo^(1 - mix); other materials: the base colour
};

// Splits the light of a facet into the targets. `metres`: depth along the camera's axis.
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
  leaving.radiance = specular + facet.emission + (skin ? vec3(0.0) : facet.colour * diffuse);
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
