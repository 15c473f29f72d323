// SPDX-License-Identifier: Apache-2.0
#include "render/compose/wrinkle_cache.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "render/settings/named_settings.h"
#include "tests/unit/render/scene_probe.h"
#include "tests/unit/render/wrinkle_cache_scene.h"

namespace furrow::render {
namespace {

using test::Compare;
using test::Difference;
using test::kShapes;
using test::Numbers;
using test::PassCounter;
using test::RequestOf;
using test::WrinkleCacheTest;

// Close-ups use the finest level, distant views coarser ones.
TEST_F(WrinkleCacheTest, NormalsMatchFragmentsForAnyWeights) {
  test::SceneProbe probe(head_);
  for (const int size : {512, 160, 48}) {
    for (int round = 0; round < 6; ++round) {
      Randomise(round == 0);
      FrameRequest request = RequestOf(subject_, camera_, View::kNormal, size);
      const std::vector<float> composed = Numbers(probe.Draw(request));
      request.settings.wrinkle_maps.cache = false;
      const Difference difference = Compare(composed, Numbers(probe.Draw(request)), 0.02);
      // In a face of 40 pixels, many pixels are at the border of a mask.
      EXPECT_LT(difference.mean, size > 100 ? 5e-4 : 1e-3) << size << " " << round;
      EXPECT_LT(difference.share, size > 100 ? 2e-3 : 1e-2) << size << " " << round;
    }
  }
}

TEST_F(WrinkleCacheTest, LightAndColourMatchFragments) {
  for (const View view : {View::kFinal, View::kAlbedo, View::kSpecular}) {
    for (int round = 0; round < 4; ++round) {
      Randomise(round == 0);
      const Difference difference = Compare(Draw(true, view).rgb, Draw(false, view).rgb, 6.0);
      EXPECT_LT(difference.mean, 0.25) << ViewName(view) << " " << round;
      EXPECT_LT(difference.share, 2e-3) << ViewName(view) << " " << round;
    }
  }
}

// Repeated changes that are too small to be visible one by one must show in sum.
TEST_F(WrinkleCacheTest, ManySmallChangesAddUp) {
  subject_.Set("l_squash", 0.2f);
  subject_.Solve();
  (void)Draw(true);
  for (int step = 1; step <= 400; ++step) {
    subject_.Set("l_squash", 0.2f + 0.0001f * static_cast<float>(step));
    subject_.Solve();
    if (step % 4 == 0) (void)Draw(true, View::kAlbedo);
  }
  EXPECT_LT(Compare(Draw(true).rgb, Draw(false).rgb, 6.0).mean, 0.25);
}

TEST_F(WrinkleCacheTest, HeldWeightsAreComposedOnce) {
  PassCounter counter;
  renderer_->SetObserver(&counter);
  Randomise(true);
  const Image first = Draw(true);
  EXPECT_EQ(counter.Take("wrinkles"), 1);
  subject_.pose.joints[1].rotation = glm::angleAxis(0.4f, glm::vec3(0, 1, 0));
  subject_.Solve();
  (void)Draw(true);
  (void)Draw(true, View::kNormal);
  EXPECT_EQ(counter.Take("wrinkles"), 0);
  Randomise(true);
  (void)Draw(true);
  EXPECT_EQ(counter.Take("wrinkles"), 1);
  (void)Draw(false);
  EXPECT_EQ(counter.Take("wrinkles"), 0);
  renderer_->SetObserver(nullptr);
}

// The same faces must look the same in any order.
TEST_F(WrinkleCacheTest, RepeatedFacesLookTheSame) {
  constexpr float kFaces[][4] = {{0.9f, 0.0f, 0.3f, 0.0f}, {0.0f, 0.7f, 0.0f, 1.0f}, {0.4f, 0.4f}};
  const auto set = [&](int face) {
    for (int i = 0; i < 4; ++i) subject_.Set(kShapes[i], kFaces[face][i]);
    subject_.Solve();
  };
  std::vector<Image> expected;
  for (int face = 0; face < 3; ++face) {
    set(face);
    expected.push_back(Draw(false));
  }
  for (const int face : {0, 1, 0, 0, 1, 2, 1, 0, 2, 0}) {
    set(face);
    const Image& whole = expected[static_cast<std::size_t>(face)];
    EXPECT_LT(Compare(Draw(true).rgb, whole.rgb, 6.0).mean, 0.25) << face;
  }
}

// A face at rest has no wrinkles, whatever was painted before.
TEST_F(WrinkleCacheTest, NothingRemainsOfAnEarlierFace) {
  const Image rest = Draw(true);
  Randomise(true);
  (void)Draw(true);
  subject_ = test::Subject(head_);
  EXPECT_EQ(Draw(true).rgb, rest.rgb);
  subject_.Set("r_stretch", 0.5f);
  subject_.Solve();
  const Image after = Draw(true);
  renderer_ = test::Expect(Renderer::Create(head_));
  EXPECT_EQ(Draw(true).rgb, after.rgb);
}

// Settings that change the appearance of wrinkles while weights stay constant.
TEST_F(WrinkleCacheTest, SettingsAffectComposedWrinkles) {
  Randomise(true);
  (void)Draw(true);
  for (const char* change : {"wrinkle_strength=0.3", "wrinkle_strength=2", "wrinkle_maps.cavity=3",
                             "wrinkle_maps.blood_flow=0.2"}) {
    FrameRequest request = RequestOf(subject_, camera_, View::kFinal, 160);
    request.settings.shading = Shading::kSkin;
    ASSERT_TRUE(SetSetting(change, &request.settings).ok());
    const Image composed = test::Expect(renderer_->Render(request));
    request.settings.wrinkle_maps.cache = false;
    const Image whole = test::Expect(renderer_->Render(request));
    EXPECT_LT(Compare(composed.rgb, whole.rgb, 6.0).mean, 0.25) << change;
  }
}

// An invisible region is painted when it becomes visible, at any size.
TEST_F(WrinkleCacheTest, RegionsThatBecomeVisibleAreUpToDate) {
  Randomise(true);
  (void)Draw(true);
  const Camera face = camera_;
  Camera away = face;  // looks at nothing
  away.target = away.position + (away.position - face.target);
  Camera near = face;
  near.fov_y_degrees = 6.0f;
  Camera far = face;
  far.fov_y_degrees = 90.0f;
  for (int round = 0; round < 6; ++round) {
    for (const Camera& camera : {away, far, near, face}) {
      camera_ = camera;
      Randomise(round == 0);
      const Image composed = Draw(true);
      EXPECT_LT(Compare(composed.rgb, Draw(false).rgb, 6.0).mean, 0.3) << round;
    }
    std::swap(near, far);
  }
}

// One renderer draws for near and far viewers in turn. Textures composed for one are kept for the
// other. When no viewer is near any more, a smaller texture replaces the large one.
TEST_F(WrinkleCacheTest, NearAndFarViewersShareTextures) {
  Randomise(true);
  Camera far = camera_;
  far.fov_y_degrees = 90.0f;
  const auto draw_far = [&] {
    (void)test::Expect(renderer_->Render(RequestOf(subject_, far, View::kNormal, 24)));
  };
  (void)Draw(true);
  draw_far();
  PassCounter counter;
  renderer_->SetObserver(&counter);
  for (int round = 0; round < 3; ++round) {
    (void)Draw(true);
    draw_far();
    EXPECT_EQ(counter.Take("wrinkles"), 0) << round;
  }
  for (int picture = 0; picture < 300; ++picture) draw_far();
  EXPECT_EQ(counter.Take("wrinkles"), 1);
  renderer_->SetObserver(nullptr);
}

// When a face is seen from farther and farther away, nothing of its former close-up remains, not
// even between two levels of the texture.
TEST_F(WrinkleCacheTest, NothingRemainsOfAnEarlierFaceFromFarAway) {
  const auto set = [&](float all, float last) {
    for (const char* shape : kShapes) subject_.Set(shape, all);
    subject_.Set(kShapes[3], last);
    subject_.Solve();
  };
  const Camera near = camera_;
  for (float fov = near.fov_y_degrees; fov < 4.0f * near.fov_y_degrees; fov *= 1.07f) {
    std::vector<Image> pictures;
    for (const float before : {1.0f, 0.002f}) {
      camera_ = near;
      for (const float last : {0.0f, 0.001f}) {  // both copies
        set(before, last);
        (void)Draw(true);
      }
      camera_.fov_y_degrees = fov;
      set(0.002f, 1.0f);
      (void)Draw(true);  // held weights are always composed
      pictures.push_back(Draw(true, View::kNormal));
    }
    const Difference difference = Compare(pictures[0].rgb, pictures[1].rgb, 2.0);
    EXPECT_EQ(difference.share, 0.0) << fov;
  }
}

TEST_F(WrinkleCacheTest, DisplacedSurfacesComposeNothing) {
  for (wrinkle::WrinkleMap& map : head_.rig.wrinkle_maps) map.height = "cavity";
  subject_ = test::Subject(head_);
  renderer_ = test::Expect(Renderer::Create(head_));
  PassCounter counter;
  renderer_->SetObserver(&counter);
  Randomise(true);
  FrameRequest request = RequestOf(subject_, camera_, View::kNormal, 96);
  request.settings.displacement.enabled = true;
  (void)test::Expect(renderer_->Render(request));
  EXPECT_EQ(counter.Take("wrinkles"), 0);
  request.settings.displacement.enabled = false;
  (void)test::Expect(renderer_->Render(request));
  EXPECT_EQ(counter.Take("wrinkles"), 1);
  renderer_->SetObserver(nullptr);
}

// Views that need each wrinkle separately compose nothing, and neither do several subjects.
TEST_F(WrinkleCacheTest, SomeFramesComposeNothing) {
  PassCounter counter;
  renderer_->SetObserver(&counter);
  Randomise(true);
  FrameRequest request = RequestOf(subject_, camera_, View::kWeights, 96);
  for (const char* change : {"view=weights", "view=mask_texture", "view=mask_dynamic",
                             "normal_blend=tangent_space", "wrinkles=off", "mask_mode=dynamic"}) {
    request.settings = {};
    ASSERT_TRUE(SetSetting(change, &request.settings).ok());
    (void)test::Expect(renderer_->Render(request));
    EXPECT_EQ(counter.Take("wrinkles"), 0) << change;
  }
  request.settings = {};
  const PosedSubject other = request;
  request.others = std::span(&other, 1);
  (void)test::Expect(renderer_->Render(request));
  EXPECT_EQ(counter.Take("wrinkles"), 0);
  request.others = {};
  (void)test::Expect(renderer_->Render(request));
  EXPECT_EQ(counter.Take("wrinkles"), 1);
  renderer_->SetObserver(nullptr);
}

}  // namespace
}  // namespace furrow::render
