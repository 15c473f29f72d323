// SPDX-License-Identifier: Apache-2.0
#include "render/settings/setting_table.h"

#include <algorithm>
#include <array>

namespace furrow::render {
namespace {

using Words = std::span<const std::string_view>;

constexpr std::array<std::string_view, 2> kShadingWords = {"diffuse", "skin"};
constexpr std::array<std::string_view, 2> kBlendWords = {"partial_derivative", "tangent_space"};
constexpr std::array<std::string_view, 3> kMaskWords = {"rig", "dynamic", "texture"};
constexpr std::array<std::string_view, 2> kToneWords = {"neutral", "clip"};
constexpr std::array<std::string_view, 3> kLightWords = {"studio", "hard", "thesis"};
constexpr std::array<std::string_view, 3> kShadowWords = {"off", "pcf", "pcss"};
constexpr std::array<std::string_view, 3> kOcclusionWords = {"off", "ssao", "gtao"};
constexpr std::array<std::string_view, 5> kSubsurfaceWords = {"off", "gaussians", "separable",
                                                              "burley", "preintegrated"};
constexpr std::array<std::string_view, 2> kSpecularWords = {"physical", "gems"};

// A field whose words name the enumerators of E, in order.
template <class E>
WordField Word(Words words, E& (*of)(Settings&)) {
  return {words, [of](const Settings& s) { return static_cast<int>(of(const_cast<Settings&>(s))); },
          [of](Settings& s, int value) { of(s) = static_cast<E>(value); }};
}

// The accessor of a member of Settings.
#define FURROW_MEMBER(member) \
  [](Settings & s) -> auto& { return s.member; }

std::vector<SettingEntry> PictureEntries() {
  return {
      {"view", "", "What the picture shows", Word<View>(ViewNames(), FURROW_MEMBER(view))},
      {"shading", "", "Shading model: plain diffuse light, or the full skin pipeline",
       Word<Shading>(kShadingWords, FURROW_MEMBER(shading))},
      {"normal_blend", "",
       "Method that adds wrinkle normals to the base normal (thesis 2.1 and 4.5)",
       Word<NormalBlend>(kBlendWords, FURROW_MEMBER(normal_blend))},
      {"mask_mode", "",
       "Kind of wrinkle masks: as the rig says for each region, or all of one kind",
       Word<MaskMode>(kMaskWords, FURROW_MEMBER(mask_mode))},
      {"wrinkles", "", "Draw wrinkles", SwitchField{FURROW_MEMBER(wrinkles)}},
      {"wrinkle_strength", "", "Scale of the depth of all wrinkles",
       NumberField{FURROW_MEMBER(wrinkle_strength), 0.0f, 4.0f}},
      {"background", "", "Background colour: linear red, green and blue",
       ColourField{FURROW_MEMBER(background)}},
      {"exposure", "", "Scale of the light before tone mapping",
       NumberField{FURROW_MEMBER(exposure), 0.0f, 16.0f, true}},
      {"tone_map", "", "Tone map: neutral compresses highlights, clip cuts them off",
       Word<ToneMap>(kToneWords, FURROW_MEMBER(tone_map))},
  };
}

std::vector<SettingEntry> LightEntries() {
  return {
      {"lights.preset", "",
       "Lamps: soft key, fill and rim; one hard key; or the thesis' three directional lights",
       Word<LightPreset>(kLightWords, FURROW_MEMBER(lights.preset))},
      {"lights.intensity", "", "Scale of the lamps' light",
       NumberField{FURROW_MEMBER(lights.intensity), 0.0f, 8.0f}},
      {"lights.ambient", "", "Scale of the sky's light",
       NumberField{FURROW_MEMBER(lights.ambient), 0.0f, 8.0f}},
      {"lights.turn_degrees", "degrees", "Rotation of the lamps around the subject",
       NumberField{FURROW_MEMBER(lights.turn_degrees), -180.0f, 180.0f}},
      {"lights.tilt_degrees", "degrees",
       "Tilt of the lamps; positive values raise the lamps in front of the subject",
       NumberField{FURROW_MEMBER(lights.tilt_degrees), -90.0f, 90.0f}},
      {"lights.key", "",
       "Colour filter of the first lamp: linear red, green and blue; 0,0,0 turns it off",
       ColourField{FURROW_MEMBER(lights.key)}},
      {"lights.fill", "", "Colour filter of the second lamp: linear red, green and blue",
       ColourField{FURROW_MEMBER(lights.fill)}},
      {"lights.rim", "", "Colour filter of the third lamp: linear red, green and blue",
       ColourField{FURROW_MEMBER(lights.rim)}},
      {"lights.sky", "", "Colour filter of the sky: linear red, green and blue",
       ColourField{FURROW_MEMBER(lights.sky)}},
      {"shadow.filter", "",
       "Shadow filter: none, fixed width (pcf), or wider with distance from the caster (pcss)",
       Word<ShadowFilter>(kShadowWords, FURROW_MEMBER(shadow.filter))},
      {"shadow.resolution", "texels", "Width and height of each lamp's shadow map",
       CountField{FURROW_MEMBER(shadow.resolution), 128, 4096}},
      {"shadow.fit", "",
       "Use smaller shadow maps when the picture or the filter cannot show more texels",
       SwitchField{FURROW_MEMBER(shadow.fit)}},
      {"shadow.lamps", "", "Number of lamps that cast shadows, in lamp order",
       CountField{FURROW_MEMBER(shadow.lamps), 0, 3}},
      {"shadow.taps", "", "Samples of the shadow filter",
       CountField{FURROW_MEMBER(shadow.taps), 1, 32}},
      {"shadow.softness_mm", "mm", "Filter radius on the surface (pcf only)",
       NumberField{FURROW_MEMBER(shadow.softness_mm), 0.0f, 50.0f}},
      {"shadow.lamp_mm", "mm", "Radius of the lamps (pcss only)",
       NumberField{FURROW_MEMBER(shadow.lamp_mm), 0.0f, 1000.0f}},
      {"shadow.normal_offset_mm", "mm",
       "Offset along the normal that prevents self-shadowing artefacts",
       NumberField{FURROW_MEMBER(shadow.normal_offset_mm), 0.0f, 20.0f}},
      {"occlusion.method", "", "Ambient occlusion: none, the thesis' SSAO, or GTAO",
       Word<OcclusionMethod>(kOcclusionWords, FURROW_MEMBER(occlusion.method))},
      {"occlusion.radius_mm", "mm", "Largest distance of a surface that occludes",
       NumberField{FURROW_MEMBER(occlusion.radius_mm), 1.0f, 500.0f}},
      {"occlusion.strength", "", "Strength of the occlusion; 0: none, 1: as computed",
       NumberField{FURROW_MEMBER(occlusion.strength), 0.0f, 2.0f}},
      {"occlusion.samples", "", "Occlusion samples per pixel",
       CountField{FURROW_MEMBER(occlusion.samples), 4, 64}},
      {"occlusion.half_resolution", "",
       "Compute occlusion at half the width and height of the picture",
       SwitchField{FURROW_MEMBER(occlusion.half_resolution)}},
  };
}

std::vector<SettingEntry> SkinEntries() {
  return {
      {"subsurface.method", "", "Method that scatters light below the skin",
       Word<SubsurfaceMethod>(kSubsurfaceWords, FURROW_MEMBER(subsurface.method))},
      {"subsurface.taps", "", "Samples of each of the two passes (separable only)",
       CountField{FURROW_MEMBER(subsurface.taps), 11, 25, {11, 17, 25}}},
      {"subsurface.samples", "", "Samples per pixel (burley only)",
       CountField{FURROW_MEMBER(subsurface.samples), 4, 64}},
      {"subsurface.width", "", "Scale of the distance that light travels in skin",
       NumberField{FURROW_MEMBER(subsurface.width), 0.0f, 8.0f}},
      {"subsurface.strength", "", "Share of the light that scatters",
       NumberField{FURROW_MEMBER(subsurface.strength), 0.0f, 1.0f}},
      {"subsurface.gradient", "",
       "How much scattering narrows where the surface turns away (beta of thesis 4.7)",
       NumberField{FURROW_MEMBER(subsurface.gradient), 0.0f, 16.0f}},
      {"subsurface.depth_range_mm", "mm",
       "Largest depth difference between surfaces that exchange light",
       NumberField{FURROW_MEMBER(subsurface.depth_range_mm), 0.1f, 1000.0f}},
      {"subsurface.mix", "", "Share of the albedo that is applied before light scatters",
       NumberField{FURROW_MEMBER(subsurface.mix), 0.0f, 1.0f}},
      {"translucency.enabled", "", "Let light through thin parts such as ears and nostrils",
       SwitchField{FURROW_MEMBER(translucency.enabled)}},
      {"translucency.strength", "", "Scale of the light through thin parts",
       NumberField{FURROW_MEMBER(translucency.strength), 0.0f, 8.0f}},
      {"translucency.scale", "", "Scale of the thickness that light passes through",
       NumberField{FURROW_MEMBER(translucency.scale), 0.01f, 100.0f}},
      {"translucency.shrink_mm", "mm", "Depth below the surface where the thickness look-up starts",
       NumberField{FURROW_MEMBER(translucency.shrink_mm), 0.0f, 20.0f}},
      {"specular.mode", "",
       "Kelemen and Szirmay-Kalos with the factor 1/pi (physical), or as printed in GPU Gems 3",
       Word<SpecularMode>(kSpecularWords, FURROW_MEMBER(specular.mode))},
      {"specular.strength", "",
       "Strength of the reflection (rho_s); GPU Gems 3 uses 0.18 with gems",
       NumberField{FURROW_MEMBER(specular.strength), 0.0f, 4.0f}},
      {"specular.roughness", "", "Scale of every material's roughness m",
       NumberField{FURROW_MEMBER(specular.roughness), 0.25f, 4.0f}},
      {"specular.second_lobe", "", "Share of a second lobe with half the roughness m",
       NumberField{FURROW_MEMBER(specular.second_lobe), 0.0f, 1.0f}},
      {"specular.conserve_energy", "", "Subtract the reflected light from the diffuse light",
       SwitchField{FURROW_MEMBER(specular.conserve_energy)}},
      {"specular.widen", "",
       "Increase the roughness m where a pixel covers many slopes of the normal maps",
       SwitchField{FURROW_MEMBER(specular.widen)}},
      {"specular.table", "",
       "Look up the Beckmann term in a table, as in GPU Gems 3, instead of computing it",
       SwitchField{FURROW_MEMBER(specular.table)}},
  };
}

std::vector<SettingEntry> SurfaceEntries() {
  return {
      {"wrinkle_maps.blood_flow", "", "Strength of the wrinkle maps' colour",
       NumberField{FURROW_MEMBER(wrinkle_maps.blood_flow), 0.0f, 4.0f}},
      {"wrinkle_maps.cavity", "", "Strength of the wrinkle maps' cavity",
       NumberField{FURROW_MEMBER(wrinkle_maps.cavity), 0.0f, 4.0f}},
      {"wrinkle_maps.cache", "",
       "Compose a single subject's wrinkles in texture space where that is cheaper",
       SwitchField{FURROW_MEMBER(wrinkle_maps.cache)}},
      {"displacement.enabled", "",
       "Move the surface by the wrinkle maps' heights, so that outlines and shadows show folds",
       SwitchField{FURROW_MEMBER(displacement.enabled)}},
      {"displacement.strength", "", "Scale of the heights",
       NumberField{FURROW_MEMBER(displacement.strength), 0.0f, 4.0f}},
      {"displacement.edge_pixels", "pixels", "Target length of triangle edges after subdivision",
       NumberField{FURROW_MEMBER(displacement.edge_pixels), 1.0f, 64.0f}},
      {"displacement.max_level", "", "Largest number of parts that a triangle edge is divided into",
       CountField{FURROW_MEMBER(displacement.max_level), 1, 64}},
      {"detail.error_pixels", "pixels",
       "Surface error allowed for small subjects among several (RMS); 0: draw all triangles",
       NumberField{FURROW_MEMBER(detail.error_pixels), 0.0f, 8.0f}},
      {"detail.hair_shadow_texels", "texels",
       "Error allowed for hair in shadow maps (RMS), at most the normal offset; 0: none",
       NumberField{FURROW_MEMBER(detail.hair_shadow_texels), 0.0f, 4.0f}},
  };
}

std::vector<SettingEntry> FinishEntries() {
  return {
      {"bloom.strength", "", "Strength of the glow around bright parts; 0: off",
       NumberField{FURROW_MEMBER(bloom.strength), 0.0f, 1.0f}},
      {"bloom.threshold", "", "Smallest linear value that glows, after exposure",
       NumberField{FURROW_MEMBER(bloom.threshold), 0.0f, 16.0f}},
      {"bloom.radius", "picture heights", "Standard deviation of the glow",
       NumberField{FURROW_MEMBER(bloom.radius), 0.001f, 0.1f}},
      {"anti_aliasing.samples", "", "Samples per pixel; 0: as many as the device can afford",
       CountField{FURROW_MEMBER(anti_aliasing.samples), 0, 8, {0, 1, 2, 4, 8}}},
      {"anti_aliasing.fxaa", "", "Smooth the edges of the finished picture (FXAA)",
       SwitchField{FURROW_MEMBER(anti_aliasing.fxaa)}},
      {"strip.views", "", "Views shown as small pictures along the right edge, from the top",
       ViewsField{FURROW_MEMBER(strip.views)}},
  };
}

#undef FURROW_MEMBER

std::vector<SettingEntry> AllEntries() {
  std::vector<SettingEntry> all;
  for (const auto& part :
       {PictureEntries(), LightEntries(), SkinEntries(), SurfaceEntries(), FinishEntries()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace

std::span<const SettingEntry> SettingTable() {
  static const std::vector<SettingEntry> table = AllEntries();
  return table;
}

const SettingEntry* FindSetting(std::string_view name) {
  const auto table = SettingTable();
  const auto found = std::ranges::find(table, name, &SettingEntry::name);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace furrow::render
