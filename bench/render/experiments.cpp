// SPDX-License-Identifier: Apache-2.0
#include "bench/render/experiments.h"

#include "bench/render/thesis_body.h"
#include "bench/render/thesis_head.h"

namespace furrow::bench {
namespace {

using render::MaskMode;
using render::OcclusionMethod;
using render::Settings;
using render::ShadowFilter;
using render::SubsurfaceMethod;

// As in the thesis: three directional lights, depth maps of 512 x 512, no anti-aliasing.
Settings Diffuse() {
  Settings settings;
  settings.wrinkles = false;
  settings.lights.preset = render::LightPreset::kThesis;
  settings.shadow.resolution = 512;
  settings.anti_aliasing.samples = 1;
  return settings;
}

Settings Wrinkled(MaskMode mode) {
  Settings settings = Diffuse();
  settings.wrinkles = true;
  settings.mask_mode = mode;
  return settings;
}

// The skin pipeline without the features that the thesis lacks.
Settings Skin(SubsurfaceMethod method) {
  Settings settings = Wrinkled(MaskMode::kTexture);
  settings.shading = render::Shading::kSkin;
  settings.subsurface.method = method;
  settings.occlusion.method = OcclusionMethod::kOff;
  settings.translucency.enabled = false;
  settings.specular.mode = render::SpecularMode::kGems;
  settings.specular.second_lobe = 0.0f;
  settings.specular.widen = false;
  return settings;
}

Settings WithOcclusion(Settings settings, OcclusionMethod method) {
  settings.occlusion.method = method;
  return settings;
}

Settings Displaced(Settings settings) {
  settings.displacement.enabled = true;
  return settings;
}

// Without simplified meshes for crowds.
Settings AllTriangles(Settings settings) {
  settings.detail.error_pixels = 0.0f;
  return settings;
}

// The skin pipeline without scattering and bloom: wrinkles, specular light and depth passes.
Settings DepthPasses(int lamps) {
  Settings settings = Skin(SubsurfaceMethod::kOff);
  settings.bloom.strength = 0.0f;
  settings.shadow.lamps = lamps;
  return settings;
}

std::unique_ptr<MovingScene> HeadScene(int heads, const ExperimentOptions& options) {
  return std::make_unique<MovingScene>(MakeHead(), HeadPlacements(heads), HeadsExtent(heads),
                                       options.size, MoveFace, options.device);
}

std::unique_ptr<MovingScene> BodyScene(int hinges, int balls, const Motion& motion,
                                       const ExperimentOptions& options) {
  return std::make_unique<MovingScene>(MakeBody(hinges, balls), std::vector{glm::mat4(1.0f)},
                                       kBodyExtent, options.size, motion, options.device);
}

// Nothing moves, so all drivers are 0.
void Rest(double, const wrinkle::Skeleton&, wrinkle::LocalPose*) {}

// Computes the relative frame rates of the thesis. A row with frame rate 0 has none.
void SetShares(Experiment* experiment) {
  for (Row& row : experiment->rows) {
    const double base = experiment->rows[row.baseline].thesis_fps;
    if (row.thesis_fps > 0.0 && base > 0.0) row.thesis_share = row.thesis_fps / base;
  }
}

}  // namespace

Experiment MakeTable51(const ExperimentOptions& options) {
  Experiment experiment{"table-5.1", "Table 5.1: a head of 3,080 triangles", {}, {}};
  experiment.scenes.push_back(HeadScene(1, options));
  const Settings gaussians = Skin(SubsurfaceMethod::kGaussians);
  experiment.rows = {
      {"diffuse, no wrinkles", 0, Diffuse(), 0, 2942.0},
      {"+ wrinkles by skinning weights", 0, Wrinkled(MaskMode::kDynamic), 0, 2860.0},
      {"+ wrinkles by texture masks", 0, Wrinkled(MaskMode::kTexture), 0, 2843.0},
      {"+ wrinkles, 1 depth pass", 0, DepthPasses(1), 0, 2694.0},
      {"+ wrinkles, 2 depth passes", 0, DepthPasses(2), 0, 2476.0},
      {"skin shading (gaussians) + wrinkles", 0, gaussians, 0, 490.0},
      {"the same + SSAO", 0, WithOcclusion(gaussians, OcclusionMethod::kSsao), 0, 308.0},
  };
  SetShares(&experiment);
  return experiment;
}

Experiment MakeTable52(const ExperimentOptions& options) {
  Experiment experiment{"table-5.2", "Table 5.2: a body of 8,290 triangles", {}, {}};
  for (const auto& [hinges, balls] : {std::pair(0, 0), {2, 1}, {100, 50}}) {
    experiment.scenes.push_back(BodyScene(hinges, balls, MoveBody, options));
    experiment.scenes.push_back(BodyScene(hinges, balls, Rest, options));
  }
  const Settings settings = Wrinkled(MaskMode::kRig);
  experiment.rows = {{"no wrinkle joints", 0, settings, 0, 3777.0},
                     {"2 hinges + 1 ball", 2, settings, 0, 3771.0},
                     {"100 hinges + 50 balls", 4, settings, 0, 3702.0},
                     {"no wrinkle joints, at rest", 1, settings, 3},
                     {"2 hinges + 1 ball, at rest", 3, settings, 3},
                     {"100 hinges + 50 balls, at rest", 5, settings, 3}};
  SetShares(&experiment);
  return experiment;
}

Experiment MakeFigure51(const ExperimentOptions& options) {
  Experiment experiment{"figure-5.1", "Figure 5.1: heads of 3,080 triangles each", {}, {}};
  for (const int heads : {1, 10, 100}) experiment.scenes.push_back(HeadScene(heads, options));
  const Settings diffuse = Wrinkled(MaskMode::kTexture);
  const Settings skin = Skin(SubsurfaceMethod::kGaussians);
  const Settings fast = Skin(SubsurfaceMethod::kSeparable);
  experiment.rows = {{"1 head, diffuse", 0, diffuse, 0},
                     {"10 heads, diffuse", 1, diffuse, 0},
                     {"100 heads, diffuse", 2, diffuse, 0},
                     {"1 head, gaussians", 0, skin, 3},
                     {"10 heads, gaussians", 1, skin, 3},
                     {"100 heads, gaussians", 2, skin, 3, 0.0, 0.34},
                     {"1 head, separable", 0, fast, 6},
                     {"10 heads, separable", 1, fast, 6},
                     {"100 heads, separable", 2, fast, 6},
                     {"100 heads, gaussians, all triangles", 2, AllTriangles(skin), 3},
                     {"100 heads, separable, all triangles", 2, AllTriangles(fast), 6}};
  return experiment;
}

Experiment MakeMethods(const ExperimentOptions& options) {
  Experiment experiment{"methods", "Skin shading of a head of 3,080 triangles, by method", {}, {}};
  experiment.scenes.push_back(HeadScene(1, options));
  const auto separable = [](int taps) {
    Settings settings = Skin(SubsurfaceMethod::kSeparable);
    settings.subsurface.taps = taps;
    return settings;
  };
  experiment.rows = {
      {"gaussians", 0, Skin(SubsurfaceMethod::kGaussians), 0},
      {"separable, 25 taps", 0, separable(25), 0},
      {"separable, 17 taps", 0, separable(17), 0},
      {"separable, 11 taps", 0, separable(11), 0},
      {"burley", 0, Skin(SubsurfaceMethod::kBurley), 0},
      {"preintegrated", 0, Skin(SubsurfaceMethod::kPreintegrated), 0},
      {"off", 0, Skin(SubsurfaceMethod::kOff), 0},
      {"separable, 17 taps + SSAO", 0, WithOcclusion(separable(17), OcclusionMethod::kSsao), 0},
      {"separable, 17 taps + GTAO", 0, WithOcclusion(separable(17), OcclusionMethod::kGtao), 0},
      {"separable, 17 taps + displacement", 0, Displaced(separable(17)), 0}};
  return experiment;
}

}  // namespace furrow::bench
