// SPDX-License-Identifier: Apache-2.0
#include "render/pipeline.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/settings/named_settings.h"
#include "test_character.h"

namespace furrow::render {
namespace {

class PipelineTest : public testing::Test {
 protected:
  void Make(const std::string& blend_shape = "l_squash") {
    renderer_ = test::Expect(Renderer::Create(head_));
    subject_ = std::make_unique<test::Subject>(head_);
    subject_->Set(blend_shape, 1.0f);
    subject_->Solve();
  }
  Image Draw(const Settings& settings, int size, const char* camera = "face") {
    FrameRequest request;
    request.model = subject_->model;
    request.binding = &subject_->binding;
    request.wrinkle_weights = subject_->weights;
    request.filtered_values = subject_->driver_values;
    request.settings = settings;
    request.camera = *renderer_->Preset(camera);
    request.width = request.height = size;
    return test::Expect(renderer_->Render(request));
  }
  static Settings Skin() {
    Settings settings;
    settings.shading = Shading::kSkin;
    return settings;
  }
  // Mean of one channel over the picture, [0, 255].
  static double Mean(const Image& image, int channel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      sum += image.rgb[i + static_cast<std::size_t>(channel)];
    }
    return 3.0 * sum / static_cast<double>(image.rgb.size());
  }

  character::Character head_ = test::MakeHead();
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<test::Subject> subject_;
};

// A picture depends on its own settings only, whatever was drawn before.
TEST_F(PipelineTest, SettingsTakeEffectWithTheNextPicture) {
  Make();
  const Image before = Draw(Skin(), 96);
  for (const char* change : {"subsurface.method=gaussians",
                             "subsurface.method=burley",
                             "subsurface.method=preintegrated",
                             "subsurface.method=off",
                             "subsurface.width=3",
                             "shadow.filter=pcss",
                             "shadow.filter=off",
                             "shadow.resolution=128",
                             "shadow.fit=off",
                             "occlusion.method=ssao",
                             "occlusion.method=off",
                             "occlusion.half_resolution=off",
                             "bloom.threshold=0.2",
                             "specular.mode=gems",
                             "specular.second_lobe=1",
                             "specular.conserve_energy=off",
                             "lights.preset=hard",
                             "lights.preset=thesis",
                             "lights.turn_degrees=90",
                             "lights.ambient=2",
                             "anti_aliasing.samples=4",
                             "tone_map=clip",
                             "subsurface.mix=0"}) {
    Settings settings = Skin();
    const Status status = SetSetting(change, &settings);
    ASSERT_TRUE(status.ok()) << status.ToString();
    (void)Draw(settings, 96);
  }
  EXPECT_EQ(Draw(Skin(), 96).rgb, before.rgb);
}

TEST_F(PipelineTest, AStripTileIsItsViewDrawnSmall) {
  Make();
  constexpr int kSize = 240;
  constexpr int kTile = kSize / 6;
  constexpr int kMargin = 4;
  Settings settings = Skin();
  settings.strip.views = {View::kAlbedo, View::kDepth};
  const Image with_strip = Draw(settings, kSize);
  settings.strip.views.clear();
  int row = kMargin;
  for (const View view : {View::kAlbedo, View::kDepth}) {
    settings.view = view;
    const Image alone = Draw(settings, kTile);
    for (int y = 0; y < kTile; ++y) {
      const auto* tile =
          &with_strip
               .rgb[3u * static_cast<std::size_t>((row + y) * kSize + kSize - kTile - kMargin)];
      ASSERT_TRUE(
          std::equal(tile, tile + 3 * kTile, &alone.rgb[3u * static_cast<std::size_t>(y * kTile)]))
          << ViewName(view) << " row " << y;
    }
    row += kTile + kMargin;
  }
}

// Counts the passes that run.
class PassCounter final : public FrameGraphObserver {
 public:
  void BeforePass(std::string_view pass) override { ++runs_[std::string(pass)]; }
  void AfterPass(std::string_view, const std::vector<Written>&) override {}
  [[nodiscard]] int runs(const std::string& pass) { return runs_[pass]; }

 private:
  std::map<std::string, int> runs_;
};

TEST_F(PipelineTest, AllViewsOfAFrameShareItsShadowMaps) {
  Make();
  Settings settings = Skin();
  settings.strip.views = {View::kShadow, View::kFinal};
  PassCounter counter;
  renderer_->SetObserver(&counter);
  (void)Draw(settings, 240);
  renderer_->SetObserver(nullptr);
  EXPECT_EQ(counter.runs("scene"), 3);
  EXPECT_EQ(counter.runs("shadows"), 1);
}

// Shadow maps are drawn when a subject or a lamp moves and are otherwise kept. Pictures from kept
// maps are identical.
TEST_F(PipelineTest, ShadowMapsAreKeptWhileNothingMoves) {
  Make();
  PassCounter counter;
  renderer_->SetObserver(&counter);
  const Image first = Draw(Skin(), 96);
  Settings settings = Skin();
  settings.specular.roughness = 2.0f;
  (void)Draw(settings, 96);
  EXPECT_EQ(Draw(Skin(), 96).rgb, first.rgb);
  EXPECT_EQ(counter.runs("shadows"), 1);
  subject_->pose.joints[2].rotation = glm::angleAxis(0.5f, glm::vec3(0.0f, 1.0f, 0.0f));
  subject_->Solve();
  const Image moved = Draw(Skin(), 96);
  EXPECT_EQ(counter.runs("shadows"), 2);
  settings = Skin();
  settings.lights.turn_degrees = 30.0f;
  (void)Draw(settings, 96);
  EXPECT_EQ(counter.runs("shadows"), 3);
  settings.shadow.lamps = 1;
  (void)Draw(settings, 96);
  EXPECT_EQ(counter.runs("shadows"), 4);
  settings.shadow.resolution = 128;
  (void)Draw(settings, 96);
  EXPECT_EQ(counter.runs("shadows"), 5);
  renderer_->SetObserver(nullptr);
  // A new renderer, which has kept nothing, draws the same.
  renderer_ = test::Expect(Renderer::Create(head_));
  EXPECT_EQ(Draw(Skin(), 96).rgb, moved.rgb);
}

// The background is even around the surfaces, although several passes leave pixels out.
TEST_F(PipelineTest, TheBackgroundIsUniform) {
  Make();
  Settings settings = Skin();
  settings.background = {0.2f, 0.05f, 0.4f};
  settings.bloom.strength = 0.0f;
  const Image image = Draw(settings, 96);
  const auto pixel = [&](int x, int y) {
    const auto at = static_cast<std::size_t>(3 * (y * 96 + x));
    return std::vector<std::uint8_t>(&image.rgb[at], &image.rgb[at] + 3);
  };
  const std::vector<std::uint8_t> corner = pixel(0, 0);
  EXPECT_GT(corner[2], corner[0]);
  EXPECT_GT(corner[0], corner[1]);
  for (const auto& [x, y] : {std::pair(95, 0), {0, 95}, {95, 95}, {48, 0}, {0, 48}, {3, 20}}) {
    EXPECT_EQ(pixel(x, y), corner) << x << ", " << y;
  }
}

// A wrinkle map with a colour: blood that a squashed brow holds back.
TEST_F(PipelineTest, BloodFlowColoursActiveMaps) {
  head_.rig.wrinkle_maps[1].colour = "blood";  // squash
  head_.rig_pictures.emplace_back("blood", static_cast<int>(head_.pictures.size()));
  head_.pictures.push_back(test::MakePicture(
      "blood", 8, [](float, float) { return glm::vec4(1.0f, 0.2f, 0.2f, 1.0f); }));
  Make();
  const Image red = Draw(Skin(), 96);
  Settings without = Skin();
  without.wrinkle_maps.blood_flow = 0.0f;
  const Image plain = Draw(without, 96);
  EXPECT_NEAR(Mean(red, 0), Mean(plain, 0), 1.5);
  EXPECT_LT(Mean(red, 1), Mean(plain, 1) - 2.0);
  Settings still = Skin();
  still.wrinkles = false;  // deactivates the map
  Settings still_without = still;
  still_without.wrinkle_maps.blood_flow = 0.0f;
  EXPECT_EQ(Draw(still, 96).rgb, Draw(still_without, 96).rgb);
}

// A wrinkle map that presses blood out of squashed skin makes it lighter than at rest.
TEST_F(PipelineTest, BloodFlowCanMakeSkinPaler) {
  head_.rig.wrinkle_maps[1].colour = "blood";
  head_.rig.wrinkle_maps[1].colour_scale = 1.5f;
  head_.rig_pictures.emplace_back("blood", static_cast<int>(head_.pictures.size()));
  head_.pictures.push_back(
      test::MakePicture("blood", 8, [](float, float) { return glm::vec4(1.0f); }));
  Make();
  Settings without = Skin();
  without.wrinkle_maps.blood_flow = 0.0f;
  const Image pale = Draw(Skin(), 96), plain = Draw(without, 96);
  for (int c = 0; c < 3; ++c) EXPECT_GT(Mean(pale, c), Mean(plain, c) + 1.0);
}

// Grazing light on a sheet of bumps: most of the bumps that face the light are in the shadow of
// others.
TEST_F(PipelineTest, BumpsAreNotOverbrightInGrazingLight) {
  const auto flat = [](float, float) { return 0.0f; };
  const auto bumpy = [](float u, float v) {
    return 0.04f * std::sin(60.0f * u) * std::sin(60.0f * v);
  };
  Settings settings = Skin();
  settings.view = View::kIrradiance;
  settings.subsurface.mix = 0.0f;
  settings.lights.preset = LightPreset::kThesis;
  settings.lights.turn_degrees = -39.0f;  // the first lamp is barely above the sheet
  settings.lights.ambient = 0.0f;
  settings.lights.fill = settings.lights.rim = glm::vec3(0.0f);
  head_ = test::MakePlane(64, flat, {flat});
  Make("r0");
  const double smooth = Mean(Draw(settings, 64), 0);
  head_ = test::MakePlane(64, bumpy, {flat});
  Make("r0");
  const double rough = Mean(Draw(settings, 64), 0);
  EXPECT_GT(smooth, 1.0);
  EXPECT_LT(rough, 1.2 * smooth);
}

// Light passes through a sheet that is lit from behind, and less through thicker flesh.
TEST_F(PipelineTest, LightPassesThroughThinSkin) {
  const auto flat = [](float, float) { return 0.0f; };
  head_ = test::MakePlane(16, flat, {flat});
  Make("r0");
  Settings settings = Skin();
  settings.view = View::kTranslucency;
  settings.translucency.shrink_mm = 0.0f;
  settings.lights.turn_degrees = 180.0f;
  const double thin = Mean(Draw(settings, 64), 0);
  EXPECT_GT(thin, 20.0);
  head_.materials[0].thickness = 0.002f;
  Make("r0");
  const Image thick = Draw(settings, 64);
  EXPECT_LT(Mean(thick, 0), 0.8 * thin);
  EXPECT_GT(Mean(thick, 0), Mean(thick, 2));  // red
  settings.translucency.enabled = false;
  EXPECT_EQ(Mean(Draw(settings, 64), 0), 0.0);
}

// A slab of 4 mm lit from behind. The look-up starts 5 mm below the front, which is outside the
// slab, and must measure the same thickness as one that starts at the front.
TEST_F(PipelineTest, TranslucencyIsDimmedInPartsThinnerThanTheLookUpDepth) {
  const auto flat = [](float, float) { return 0.0f; };
  head_ = test::MakePlane(16, flat, {flat});
  head_.materials[0].double_sided = true;
  Settings settings = Skin();
  settings.view = View::kTranslucency;
  settings.lights = {LightPreset::kThesis, 0.2f, 1.0f, 180.0f};  // parallel light, for exact depths
  Make("r0");
  const double bare = Mean(Draw(settings, 64), 0);
  head_.meshes.push_back(head_.meshes[0]);
  for (character::Vertex& vertex : head_.meshes[1].vertices) vertex.position.z -= 0.004f;
  Make("r0");
  const double below = Mean(Draw(settings, 64), 0);
  settings.translucency.shrink_mm = 0.0f;
  const double at = Mean(Draw(settings, 64), 0);
  EXPECT_GT(at, 1.0);
  EXPECT_NEAR(below, at, 0.05 * at);
  EXPECT_LT(below, 0.8 * bare);
}

TEST_F(PipelineTest, ACharacterWithoutSkinIsDrawn) {
  for (character::Material& material : head_.materials) {
    material.kind = character::Material::Kind::kCloth;
  }
  Make();
  EXPECT_GT(Mean(Draw(Skin(), 64), 0), 20.0);
}

}  // namespace
}  // namespace furrow::render
