// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "base/status.h"

// What a picture shows and how it is drawn: one structure, every part of which can be set from a
// TOML file, a command line or a page by its name ("subsurface.method"). All are hot: the next
// frame has them, and only what depends on a setting is made anew.
namespace furrow::render {

// The finished picture, data of the surface, or the target of one stage of the pipeline. Those from
// kShadow on belong to the skin pipeline and are drawn with it whatever Settings::shading says.
enum class View {
  kFinal,
  kNormal,
  kMaskDynamic,
  kMaskTexture,
  kWeights,
  kWireframe,
  kShadow,        // light that reaches the surface: the first three lights in red, green, blue
  kIrradiance,    // diffuse light on skin, before scattering (times albedo^mix)
  kScattered,     // the same after scattering
  kSpecular,      // specular light alone
  kTranslucency,  // light through thin parts alone
  kAlbedo,
  kDepth,      // linear: white to black over the picture's own width, the target in the middle
  kMaterial,   // skin red, cloth blue, eyes white, hair green, others grey
  kOcclusion,  // 1: open
  kBloom,
  kShadowMaps,  // the lamps' depth maps side by side: white is near, black where nothing is
};
inline constexpr int kNumViews = 17;

[[nodiscard]] std::string_view ViewName(View view);           // "mask_dynamic"
[[nodiscard]] Result<View> ParseView(std::string_view name);  // error lists the names

enum class NormalBlend { kPartialDerivative, kTangentSpace };  // 2.1 / 4.5
enum class MaskMode { kRig, kDynamic, kTexture };  // as each region says, or all of one kind
enum class Shading { kDiffuse, kSkin };
enum class LightPreset { kStudio, kHard, kThesis };
enum class ShadowFilter { kOff, kPcf, kPcss };
enum class OcclusionMethod { kOff, kSsao, kGtao };
enum class SubsurfaceMethod { kOff, kGaussians, kSeparable, kBurley, kPreintegrated };
enum class SpecularMode { kPhysical, kGems };
enum class ToneMap { kNeutral, kClip };

struct LightSettings {
  LightPreset preset = LightPreset::kStudio;
  float intensity = 1.0f;     // of the lamps, [0, 8]
  float ambient = 1.0f;       // of the sky, [0, 8]
  float turn_degrees = 0.0f;  // the lamps about the subject, [-180, 180]
  float tilt_degrees = 0.0f;  // ... and those in front of it upwards, [-90, 90]
  // Filters of the lamps, in their order, and of the sky: linear red, green and blue, [0, 1].
  glm::vec3 key{1.0f};
  glm::vec3 fill{1.0f};
  glm::vec3 rim{1.0f};
  glm::vec3 sky{1.0f};
};

struct ShadowSettings {
  ShadowFilter filter = ShadowFilter::kPcf;
  int resolution = 1024;          // texels a side of each light's map, [128, 4096]
  bool fit = true;                // ... at most: as many as the picture and the filter can show
  int lamps = 3;                  // how many of the lamps cast shadows, in their order, [0, 3]
  int taps = 8;                   // of the filter, [1, 32]
  float softness_mm = 3.0f;       // pcf: radius of the filter on the surface, [0, 50]
  float lamp_mm = 60.0f;          // pcss: radius of the lamp, [0, 1000]
  float normal_offset_mm = 1.0f;  // keeps a surface from shading itself, [0, 20]
};

struct OcclusionSettings {
  OcclusionMethod method = OcclusionMethod::kGtao;
  float radius_mm = 25.0f;  // how far a surface may stand and still count, [1, 500]
  float strength = 1.0f;    // [0, 2]
  int samples = 12;         // a pixel, [4, 64]
  bool half_resolution = true;
};

struct SubsurfaceSettings {
  SubsurfaceMethod method = SubsurfaceMethod::kSeparable;
  int taps = 17;                // separable: 11, 17 or 25
  int samples = 24;             // burley: [4, 64]
  float width = 1.0f;           // scales the profile's millimetres, [0, 8]
  float strength = 1.0f;        // 0: as if off, 1: all light scatters
  float gradient = 1.0f;        // beta of 4.7: narrower where the surface turns away, [0, 16]
  float depth_range_mm = 6.0f;  // taps further apart in depth are left out, [0.1, 1000]
  float mix = 0.5f;             // share of the albedo applied before scattering, [0, 1]
};

struct TranslucencySettings {
  bool enabled = true;
  float strength = 1.0f;   // [0, 8]
  float scale = 1.0f;      // of the thickness that light meets, [0.01, 100]
  float shrink_mm = 5.0f;  // the look-up starts so far below the surface, [0, 20]
};

struct SpecularSettings {
  SpecularMode mode = SpecularMode::kPhysical;
  float strength = 1.0f;        // rho_s, [0, 4]; gems: 0.18 is the published value
  float roughness = 1.0f;       // scales every material's m, [0.25, 4]
  float second_lobe = 0.3f;     // share of the lobe with m / 2, [0, 1]
  bool conserve_energy = true;  // diffuse gets what the specular leaves (rho_dt)
  bool widen = true;            // m grows by the second moments of the normal maps
  bool table = false;           // Beckmann's term is looked up and not worked out (GPU Gems 3)
};

struct WrinkleSettings {
  float blood_flow = 1.0f;  // strength of the maps' colour, [0, 4]
  float cavity = 1.0f;      // ... and of their cavity, [0, 4]
  // Wrinkles of a single subject are composed in texture space where that is cheaper, and
  // anew only where weights change; off: in every fragment.
  bool cache = true;
};

// The surface itself moves by the height maps of the rig's wrinkle maps, so that outlines and
// shadows fold too. Maps without heights, and the view wireframe, stay as they are.
struct DisplacementSettings {
  bool enabled = false;
  float strength = 1.0f;     // scales the heights, [0, 4]; shading goes with 1
  float edge_pixels = 4.0f;  // triangles are divided until edges are so long, [1, 64]
  int max_level = 16;        // ... or divided into so many, [1, 64]
};

struct DetailSettings {
  // Of several subjects, who is small in the picture is drawn with fewer triangles, whose surface
  // is off by so many pixels (RMS): [0, 8]. 0: all triangles, always. A single one always has all.
  float error_pixels = 0.5f;
  // Hair as lamps see it may be off by so many texels of the shadow maps (RMS), and never by more
  // than ShadowSettings::normal_offset_mm, which hides it: [0, 4]. 0: as the camera sees it.
  float hair_shadow_texels = 0.5f;
};

struct BloomSettings {
  float strength = 0.05f;  // [0, 1]; 0: off
  float threshold = 1.0f;  // linear, after exposure, [0, 16]
  float radius = 0.015f;   // standard deviation as a share of the picture's height, [0.001, 0.1]
};

struct AntiAliasingSettings {
  // Of the scene's targets: 1, 2, 4 or 8. 0: 4; but with skin shading on a software device, which
  // pays for every sample of every target, 1 and FXAA.
  int samples = 0;
  bool fxaa = false;  // on the finished picture
};

struct StripSettings {
  std::vector<View> views;  // small at the right-hand side, from the top; at most 6
};

// Defaults draw a portrait. CheckSettings() says what is out of range.
struct Settings {
  View view = View::kFinal;
  Shading shading = Shading::kDiffuse;
  NormalBlend normal_blend = NormalBlend::kPartialDerivative;
  MaskMode mask_mode = MaskMode::kRig;
  bool wrinkles = true;
  float wrinkle_strength = 1.0f;                 // [0, 4]
  glm::vec3 background{0.028f, 0.029f, 0.031f};  // linear, [0, 1]
  float exposure = 1.0f;                         // (0, 16]
  ToneMap tone_map = ToneMap::kNeutral;
  LightSettings lights;
  ShadowSettings shadow;
  OcclusionSettings occlusion;
  SubsurfaceSettings subsurface;
  TranslucencySettings translucency;
  SpecularSettings specular;
  WrinkleSettings wrinkle_maps;
  DisplacementSettings displacement;
  DetailSettings detail;
  BloomSettings bloom;
  AntiAliasingSettings anti_aliasing;
  StripSettings strip;
};

// Whether a picture of `view` is drawn by the skin pipeline, with shadows, and not by the plain
// one.
[[nodiscard]] bool NeedsSkinPipeline(View view, const Settings& settings);

// What can be said of one setting by name: for help texts and pages.
struct SettingInfo {
  enum class Kind { kNumber, kCount, kSwitch, kColour, kWord, kViews };
  std::string_view name;  // "subsurface.method"
  std::string_view unit;  // "mm"; empty: a plain number or none
  std::string_view help;
  std::string allowed;        // "off, gaussians, separable, burley, preintegrated", "[0, 8]"
  std::string default_value;  // as SetSetting() takes it
  Kind kind = Kind::kNumber;
  float low = 0.0f;  // numbers and counts
  float high = 0.0f;
  std::vector<std::string> choices;  // words, views, and counts of which few are allowed
};
// Every setting, in the order of the structure.
[[nodiscard]] const std::vector<SettingInfo>& AllSettings();

// Sets one by name from its text: a number, on/off/true/false, a word, "r,g,b", or words joined by
// commas. Errors: kNotFound (no such setting: lists those that are near), kInvalidArgument (not
// among what is allowed, which the message lists); `where` is the name.
[[nodiscard]] Status SetSetting(std::string_view name, std::string_view value, Settings* settings);
// "name=value" of a command line.
[[nodiscard]] Status SetSetting(std::string_view assignment, Settings* settings);
// The text that SetSetting() takes. Precondition: AllSettings() has the name.
[[nodiscard]] std::string GetSetting(std::string_view name, const Settings& settings);

// Reads TOML over `settings`: what the text does not say stays. Tables are the part before the dot.
// Errors: kNotFound, kIo, kParse, kSchema (no such setting, or a value of another type),
// kInvalidArgument (not allowed); `where` is "file:line", the message names the setting.
[[nodiscard]] Status LoadSettings(const std::filesystem::path& path, Settings* settings);
[[nodiscard]] Status ParseSettings(std::string_view toml, std::string_view source_name,
                                   Settings* settings);
// All of them as TOML with their meaning, unit and range as comments; ParseSettings() reads it back
// equal.
[[nodiscard]] std::string SettingsToToml(const Settings& settings);

// Whether some view that the picture shows, itself or in its strip, is one that is asked for.
template <class Predicate>
[[nodiscard]] bool AnyView(const Settings& settings, const Predicate& is_asked_for) {
  return is_asked_for(settings.view) || std::ranges::any_of(settings.strip.views, is_asked_for);
}

// kInvalidArgument: `where` is "settings.<name>".
[[nodiscard]] Status CheckSettings(const Settings& settings);

}  // namespace furrow::render
