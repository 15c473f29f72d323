// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <glm/vec3.hpp>

#include "render/settings/view.h"

// What a picture shows and how it is drawn. Settings is a plain structure; named_settings.h reads
// and writes each member by name ("subsurface.method"), and settings_file.h does so for TOML files.
// A change takes effect with the next frame, which rebuilds only what depends on it.
namespace furrow::render {

// How the slopes of wrinkle maps are added to the base normal (thesis 2.1 and 4.5).
enum class NormalBlend { kPartialDerivative, kTangentSpace };
// Which masks limit wrinkles: per region the kind that the rig states, skinning masks for all, or
// painted masks for all.
enum class MaskMode { kRig, kDynamic, kTexture };
enum class Shading { kDiffuse, kSkin };
enum class LightPreset { kStudio, kHard, kThesis };
enum class ShadowFilter { kOff, kPcf, kPcss };
enum class OcclusionMethod { kOff, kSsao, kGtao };
enum class SubsurfaceMethod { kOff, kGaussians, kSeparable, kBurley, kPreintegrated };
enum class SpecularMode { kPhysical, kGems };
enum class ToneMap { kNeutral, kClip };

struct LightSettings {
  LightPreset preset = LightPreset::kStudio;
  float intensity = 1.0f;     // scales the lamps, [0, 8]
  float ambient = 1.0f;       // scales the sky, [0, 8]
  float turn_degrees = 0.0f;  // turns the lamps around the subject, [-180, 180]
  float tilt_degrees = 0.0f;  // raises the lamps in front of the subject, [-90, 90]
  // Colour filters of the three lamps and of the sky: linear red, green and blue, [0, 1].
  glm::vec3 key{1.0f};
  glm::vec3 fill{1.0f};
  glm::vec3 rim{1.0f};
  glm::vec3 sky{1.0f};

  friend bool operator==(const LightSettings&, const LightSettings&) = default;
};

struct ShadowSettings {
  ShadowFilter filter = ShadowFilter::kPcf;
  int resolution = 1024;          // texels per side of each lamp's map, [128, 4096]
  bool fit = true;                // use fewer texels where the picture or filter cannot show them
  int lamps = 3;                  // number of lamps that cast shadows, in lamp order, [0, 3]
  int taps = 8;                   // samples of the filter, [1, 32]
  float softness_mm = 3.0f;       // pcf: radius of the filter on the surface, [0, 50]
  float lamp_mm = 60.0f;          // pcss: radius of the lamp, [0, 1000]
  float normal_offset_mm = 1.0f;  // offset that prevents self-shadowing artefacts, [0, 20]

  friend bool operator==(const ShadowSettings&, const ShadowSettings&) = default;
};

struct OcclusionSettings {
  OcclusionMethod method = OcclusionMethod::kGtao;
  float radius_mm = 25.0f;  // largest distance of a surface that occludes, [1, 500]
  float strength = 1.0f;    // [0, 2]
  int samples = 12;         // per pixel, [4, 64]
  bool half_resolution = true;

  friend bool operator==(const OcclusionSettings&, const OcclusionSettings&) = default;
};

struct SubsurfaceSettings {
  SubsurfaceMethod method = SubsurfaceMethod::kSeparable;
  int taps = 17;          // separable: samples per pass, 11, 17 or 25
  int samples = 24;       // burley: samples per pixel, [4, 64]
  float width = 1.0f;     // scales the diffusion profile's distances, [0, 8]
  float strength = 1.0f;  // share of the light that scatters, [0, 1]
  float gradient = 1.0f;  // beta of thesis 4.7: narrows the kernel on slanted surfaces, [0, 16]
  float depth_range_mm = 6.0f;  // largest depth difference of samples that mix, [0.1, 1000]
  // Exponent: albedo^mix is applied before scattering and the rest after it. 0: all after, 1: all
  // before; [0, 1].
  float mix = 0.5f;

  friend bool operator==(const SubsurfaceSettings&, const SubsurfaceSettings&) = default;
};

struct TranslucencySettings {
  bool enabled = true;
  float strength = 1.0f;   // [0, 8]
  float scale = 1.0f;      // scales the thickness that light passes through, [0.01, 100]
  float shrink_mm = 5.0f;  // depth below the surface where the thickness look-up starts, [0, 20]

  friend bool operator==(const TranslucencySettings&, const TranslucencySettings&) = default;
};

struct SpecularSettings {
  SpecularMode mode = SpecularMode::kPhysical;
  float strength = 1.0f;        // factor rho_s of the reflection, [0, 4]; GPU Gems 3 uses 0.18
  float roughness = 1.0f;       // scales the roughness m of every material, [0.25, 4]
  float second_lobe = 0.3f;     // share of a second lobe of roughness m / 2, [0, 1]
  bool conserve_energy = true;  // subtract reflected light from the diffuse light
  bool widen = true;            // enlarge m by the variance of the normal map's slopes
  bool table = false;           // look up the Beckmann term as in GPU Gems 3; off: compute it

  friend bool operator==(const SpecularSettings&, const SpecularSettings&) = default;
};

struct WrinkleSettings {
  float blood_flow = 1.0f;  // strength of the wrinkle maps' colour, [0, 4]
  float cavity = 1.0f;      // strength of the wrinkle maps' cavity, [0, 4]
  // Compose the wrinkles of a single subject in texture space where that is cheaper, and only where
  // weights changed. Off: evaluate them in every fragment.
  bool cache = true;

  friend bool operator==(const WrinkleSettings&, const WrinkleSettings&) = default;
};

// Moves the surface by the height maps of the rig's wrinkle maps, so that outlines and shadows show
// the folds. Maps without heights and the view wireframe are unaffected.
struct DisplacementSettings {
  bool enabled = false;
  float strength = 1.0f;     // scales the heights, [0, 4]; the normal maps match strength 1
  float edge_pixels = 4.0f;  // target length of a subdivided triangle edge, [1, 64]
  int max_level = 16;        // largest number of parts of an edge, [1, 64]

  friend bool operator==(const DisplacementSettings&, const DisplacementSettings&) = default;
};

struct DetailSettings {
  // With several subjects, allowed surface error (RMS, pixels) of the simplified meshes of small
  // ones, [0, 8]. 0: always draw all triangles. A single subject has all triangles,
  // but for its hair in motion.
  float error_pixels = 0.5f;
  // Allowed error (RMS, shadow-map texels) of hair in shadow maps, [0, 4]. An error above
  // ShadowSettings::normal_offset_mm, which hides smaller ones, is never allowed. 0: shadow maps
  // use the mesh that the camera sees.
  float hair_shadow_texels = 0.5f;

  friend bool operator==(const DetailSettings&, const DetailSettings&) = default;
};

struct BloomSettings {
  float strength = 0.05f;  // [0, 1]; 0: off
  float threshold = 1.0f;  // linear, after exposure, [0, 16]
  float radius = 0.015f;   // standard deviation as a share of the picture's height, [0.001, 0.1]

  friend bool operator==(const BloomSettings&, const BloomSettings&) = default;
};

struct AntiAliasingSettings {
  // Samples per pixel of the scene's targets: 1, 2, 4 or 8. 0: 4, except for skin shading on a
  // software device, where every sample of every target costs time: 1, and FXAA is on.
  int samples = 0;
  bool fxaa = false;  // on the finished picture

  friend bool operator==(const AntiAliasingSettings&, const AntiAliasingSettings&) = default;
};

struct StripSettings {
  std::vector<View> views;  // small pictures along the right edge, from the top, at most 6

  friend bool operator==(const StripSettings&, const StripSettings&) = default;
};

// Defaults draw a portrait. CheckSettings() of named_settings.h validates the ranges.
struct Settings {
  View view = View::kFinal;
  Shading shading = Shading::kDiffuse;
  NormalBlend normal_blend = NormalBlend::kPartialDerivative;
  MaskMode mask_mode = MaskMode::kRig;
  bool wrinkles = true;
  float wrinkle_strength = 1.0f;                 // scales the slopes of all wrinkles, [0, 4]
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

  friend bool operator==(const Settings&, const Settings&) = default;
};

// Returns true if the skin pipeline, with shadows, draws `view`; false: the plain one does.
[[nodiscard]] bool NeedsSkinPipeline(View view, const Settings& settings);

// Returns true if `predicate` holds for the picture's own view or for a view of its strip.
template <class Predicate>
[[nodiscard]] bool AnyView(const Settings& settings, const Predicate& predicate) {
  return predicate(settings.view) || std::ranges::any_of(settings.strip.views, predicate);
}

}  // namespace furrow::render
