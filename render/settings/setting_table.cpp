// SPDX-License-Identifier: Apache-2.0
#include "render/settings/setting_table.h"

#include <algorithm>
#include <array>

namespace furrow::render {
namespace {

using Words = std::span<const std::string_view>;

constexpr std::array<std::string_view, kNumViews> kViewNames = {
    "final",  "normal",     "mask_dynamic", "mask_texture", "weights",      "wireframe",
    "shadow", "irradiance", "scattered",    "specular",     "translucency", "albedo",
    "depth",  "material",   "occlusion",    "bloom",        "shadow_maps"};
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

// A field whose words are the enumerators of E, in their order.
template <class E>
WordField Word(Words words, E& (*of)(Settings&)) {
  return {words, [of](const Settings& s) { return static_cast<int>(of(const_cast<Settings&>(s))); },
          [of](Settings& s, int value) { of(s) = static_cast<E>(value); }};
}

// What the structure says of a member, once more by name.
#define FURROW_MEMBER(member) \
  [](Settings & s) -> auto& { return s.member; }

std::vector<SettingEntry> PictureEntries() {
  return {
      {"view", "", "What the picture shows", Word<View>(kViewNames, FURROW_MEMBER(view))},
      {"shading", "", "Plain diffuse light, or the whole skin pipeline",
       Word<Shading>(kShadingWords, FURROW_MEMBER(shading))},
      {"normal_blend", "", "How wrinkle normals are added (thesis 2.1, 4.5)",
       Word<NormalBlend>(kBlendWords, FURROW_MEMBER(normal_blend))},
      {"mask_mode", "", "Masks as the rig says, or all of one kind",
       Word<MaskMode>(kMaskWords, FURROW_MEMBER(mask_mode))},
      {"wrinkles", "", "Whether there are any", SwitchField{FURROW_MEMBER(wrinkles)}},
      {"wrinkle_strength", "", "Scales the depth of all wrinkles",
       NumberField{FURROW_MEMBER(wrinkle_strength), 0.0f, 4.0f}},
      {"background", "", "Linear red, green and blue", ColourField{FURROW_MEMBER(background)}},
      {"exposure", "", "Scales the light before the tone map",
       NumberField{FURROW_MEMBER(exposure), 0.0f, 16.0f, true}},
      {"tone_map", "", "neutral compresses highlights, clip cuts them",
       Word<ToneMap>(kToneWords, FURROW_MEMBER(tone_map))},
  };
}

std::vector<SettingEntry> LightEntries() {
  return {
      {"lights.preset", "", "Soft key, fill and rim; one hard key; three directional lights",
       Word<LightPreset>(kLightWords, FURROW_MEMBER(lights.preset))},
      {"lights.intensity", "", "Scales the lamps",
       NumberField{FURROW_MEMBER(lights.intensity), 0.0f, 8.0f}},
      {"lights.ambient", "", "Scales the sky",
       NumberField{FURROW_MEMBER(lights.ambient), 0.0f, 8.0f}},
      {"lights.turn_degrees", "degrees", "Turns the lamps about the subject",
       NumberField{FURROW_MEMBER(lights.turn_degrees), -180.0f, 180.0f}},
      {"lights.tilt_degrees", "degrees", "Tilts the lamps: those in front of the subject go up",
       NumberField{FURROW_MEMBER(lights.tilt_degrees), -90.0f, 90.0f}},
      {"lights.key", "", "Filter of the first lamp: linear red, green and blue; 0,0,0: off",
       ColourField{FURROW_MEMBER(lights.key)}},
      {"lights.fill", "", "Filter of the second lamp", ColourField{FURROW_MEMBER(lights.fill)}},
      {"lights.rim", "", "Filter of the third lamp", ColourField{FURROW_MEMBER(lights.rim)}},
      {"lights.sky", "", "Filter of the sky", ColourField{FURROW_MEMBER(lights.sky)}},
      {"shadow.filter", "", "None, a filter of fixed width, or one that widens with distance",
       Word<ShadowFilter>(kShadowWords, FURROW_MEMBER(shadow.filter))},
      {"shadow.resolution", "texels", "Side of each lamp's shadow map",
       CountField{FURROW_MEMBER(shadow.resolution), 128, 4096}},
      {"shadow.fit", "", "Smaller maps where neither picture nor filter can show more texels",
       SwitchField{FURROW_MEMBER(shadow.fit)}},
      {"shadow.lamps", "", "How many of the lamps cast shadows, in their order",
       CountField{FURROW_MEMBER(shadow.lamps), 0, 3}},
      {"shadow.taps", "", "Look-ups of the filter", CountField{FURROW_MEMBER(shadow.taps), 1, 32}},
      {"shadow.softness_mm", "mm", "pcf: radius of the filter on the surface",
       NumberField{FURROW_MEMBER(shadow.softness_mm), 0.0f, 50.0f}},
      {"shadow.lamp_mm", "mm", "pcss: radius of the lamp",
       NumberField{FURROW_MEMBER(shadow.lamp_mm), 0.0f, 1000.0f}},
      {"shadow.normal_offset_mm", "mm", "Keeps a surface from shading itself",
       NumberField{FURROW_MEMBER(shadow.normal_offset_mm), 0.0f, 20.0f}},
      {"occlusion.method", "", "Ambient occlusion: none, the thesis' SSAO, or GTAO",
       Word<OcclusionMethod>(kOcclusionWords, FURROW_MEMBER(occlusion.method))},
      {"occlusion.radius_mm", "mm", "How far a surface may stand and still count",
       NumberField{FURROW_MEMBER(occlusion.radius_mm), 1.0f, 500.0f}},
      {"occlusion.strength", "", "0: none, 1: as computed",
       NumberField{FURROW_MEMBER(occlusion.strength), 0.0f, 2.0f}},
      {"occlusion.samples", "", "Look-ups a pixel",
       CountField{FURROW_MEMBER(occlusion.samples), 4, 64}},
      {"occlusion.half_resolution", "", "Computed for every fourth pixel",
       SwitchField{FURROW_MEMBER(occlusion.half_resolution)}},
  };
}

std::vector<SettingEntry> SkinEntries() {
  return {
      {"subsurface.method", "", "How light scatters below the skin",
       Word<SubsurfaceMethod>(kSubsurfaceWords, FURROW_MEMBER(subsurface.method))},
      {"subsurface.taps", "", "separable: look-ups of each of its two passes",
       CountField{FURROW_MEMBER(subsurface.taps), 11, 25, {11, 17, 25}}},
      {"subsurface.samples", "", "burley: look-ups a pixel",
       CountField{FURROW_MEMBER(subsurface.samples), 4, 64}},
      {"subsurface.width", "", "Scales how far light travels",
       NumberField{FURROW_MEMBER(subsurface.width), 0.0f, 8.0f}},
      {"subsurface.strength", "", "Share of the light that scatters",
       NumberField{FURROW_MEMBER(subsurface.strength), 0.0f, 1.0f}},
      {"subsurface.gradient", "", "Narrower where the surface turns away (beta of thesis 4.7)",
       NumberField{FURROW_MEMBER(subsurface.gradient), 0.0f, 16.0f}},
      {"subsurface.depth_range_mm", "mm", "Surfaces further apart in depth do not exchange light",
       NumberField{FURROW_MEMBER(subsurface.depth_range_mm), 0.1f, 1000.0f}},
      {"subsurface.mix", "", "Share of the albedo that is applied before the light scatters",
       NumberField{FURROW_MEMBER(subsurface.mix), 0.0f, 1.0f}},
      {"translucency.enabled", "", "Light through ears and nostrils",
       SwitchField{FURROW_MEMBER(translucency.enabled)}},
      {"translucency.strength", "", "Scales that light",
       NumberField{FURROW_MEMBER(translucency.strength), 0.0f, 8.0f}},
      {"translucency.scale", "", "Scales the thickness that light meets",
       NumberField{FURROW_MEMBER(translucency.scale), 0.01f, 100.0f}},
      {"translucency.shrink_mm", "mm", "The look-up starts so far below the surface",
       NumberField{FURROW_MEMBER(translucency.shrink_mm), 0.0f, 20.0f}},
      {"specular.mode", "", "Kelemen and Szirmay-Kalos with the 1/pi, or as GPU Gems printed it",
       Word<SpecularMode>(kSpecularWords, FURROW_MEMBER(specular.mode))},
      {"specular.strength", "", "rho_s; published for gems: 0.18",
       NumberField{FURROW_MEMBER(specular.strength), 0.0f, 4.0f}},
      {"specular.roughness", "", "Scales the m of every material",
       NumberField{FURROW_MEMBER(specular.roughness), 0.25f, 4.0f}},
      {"specular.second_lobe", "", "Share of a second lobe with half the m",
       NumberField{FURROW_MEMBER(specular.second_lobe), 0.0f, 1.0f}},
      {"specular.conserve_energy", "", "Diffuse light is what the specular leaves",
       SwitchField{FURROW_MEMBER(specular.conserve_energy)}},
      {"specular.widen", "", "m grows where a pixel covers many slopes of the normal maps",
       SwitchField{FURROW_MEMBER(specular.widen)}},
      {"specular.table", "", "Beckmann's term is looked up (GPU Gems 3), not worked out",
       SwitchField{FURROW_MEMBER(specular.table)}},
      {"wrinkle_maps.blood_flow", "", "Strength of the maps' colour",
       NumberField{FURROW_MEMBER(wrinkle_maps.blood_flow), 0.0f, 4.0f}},
      {"wrinkle_maps.cavity", "", "Strength of the maps' cavity",
       NumberField{FURROW_MEMBER(wrinkle_maps.cavity), 0.0f, 4.0f}},
      {"wrinkle_maps.cache", "",
       "Wrinkles of a single subject are composed once, in the texture, where that is cheaper",
       SwitchField{FURROW_MEMBER(wrinkle_maps.cache)}},
      {"displacement.enabled", "", "The maps' heights move the surface: outlines fold too",
       SwitchField{FURROW_MEMBER(displacement.enabled)}},
      {"displacement.strength", "", "Scales the heights",
       NumberField{FURROW_MEMBER(displacement.strength), 0.0f, 4.0f}},
      {"displacement.edge_pixels", "pixels", "Triangles are divided until edges are so long",
       NumberField{FURROW_MEMBER(displacement.edge_pixels), 1.0f, 64.0f}},
      {"displacement.max_level", "", "Most parts that an edge is divided into",
       CountField{FURROW_MEMBER(displacement.max_level), 1, 64}},
      {"detail.error_pixels", "pixels",
       "Of several subjects, who is small has fewer triangles, off by so much; 0: never",
       NumberField{FURROW_MEMBER(detail.error_pixels), 0.0f, 8.0f}},
      {"detail.hair_shadow_texels", "texels",
       "How far hair may be off in shadow maps, within the normal offset; 0: as drawn",
       NumberField{FURROW_MEMBER(detail.hair_shadow_texels), 0.0f, 4.0f}},
  };
}

std::vector<SettingEntry> FinishEntries() {
  return {
      {"bloom.strength", "", "Light that bright parts spread; 0: off",
       NumberField{FURROW_MEMBER(bloom.strength), 0.0f, 1.0f}},
      {"bloom.threshold", "", "From which linear value on, after exposure",
       NumberField{FURROW_MEMBER(bloom.threshold), 0.0f, 16.0f}},
      {"bloom.radius", "picture heights", "Standard deviation of the spread",
       NumberField{FURROW_MEMBER(bloom.radius), 0.001f, 0.1f}},
      {"anti_aliasing.samples", "", "Of the scene's targets; 0: as the device can afford",
       CountField{FURROW_MEMBER(anti_aliasing.samples), 0, 8, {0, 1, 2, 4, 8}}},
      {"anti_aliasing.fxaa", "", "Smooths the finished picture's edges",
       SwitchField{FURROW_MEMBER(anti_aliasing.fxaa)}},
      {"strip.views", "", "Views shown small at the right-hand side, from the top",
       ViewsField{FURROW_MEMBER(strip.views)}},
  };
}

#undef FURROW_MEMBER

std::vector<SettingEntry> AllEntries() {
  std::vector<SettingEntry> all;
  for (const auto& part : {PictureEntries(), LightEntries(), SkinEntries(), FinishEntries()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace

std::span<const std::string_view> ViewNames() { return kViewNames; }

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
