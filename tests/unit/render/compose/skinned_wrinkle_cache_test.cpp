// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "render/compose/wrinkle_cache.h"
#include "tests/unit/render/scene_probe.h"
#include "tests/unit/render/wrinkle_cache_scene.h"

namespace furrow::render {
namespace {

// Tests of the wrinkle cache with masks by skin weights.
using test::Compare;
using test::Difference;
using test::Numbers;
using test::PassCounter;
using test::RequestOf;
using test::WrinkleCacheTest;

// The egg with muscles, so that its regions can be masked by skin weights: the forehead by the brow
// joint, everything else by the head.
class SkinnedWrinkleCacheTest : public WrinkleCacheTest {
 protected:
  SkinnedWrinkleCacheTest() {
    wrinkle::Rig& rig = head_.rig;
    wrinkle::Driver hinge = rig.drivers.back();
    hinge.name = "nod";
    hinge.hinge.parent = "root";
    hinge.hinge.joint = "head";
    rig.drivers.push_back(hinge);
    rig.regions[0].feeds[0].sources.push_back({"brow", "flexed", 0.8f});
    rig.regions[1].feeds[1].sources.push_back({"nod", "flexed", 1.0f});
    Rebuild();
  }
  void Rebuild() {
    subject_ = test::Subject(head_);
    renderer_ = test::Expect(Renderer::Create(head_));
  }
  void Bend() {
    std::uniform_real_distribution<float> angle(-1.5f, 1.5f);
    for (const std::size_t joint : {1u, 2u}) {
      subject_.pose.joints[joint].rotation = glm::angleAxis(angle(random_), glm::vec3(1, 0, 0));
    }
    Randomise(false);
  }
  FrameRequest Request(MaskMode mode, bool cache, int size = 160) {
    FrameRequest request = RequestOf(subject_, camera_, View::kNormal, size);
    request.settings.mask_mode = mode;
    request.settings.wrinkle_maps.cache = cache;
    return request;
  }
  // The number of compositions for a frame.
  int Composed(const FrameRequest& request) {
    PassCounter counter;
    renderer_->SetObserver(&counter);
    (void)test::Expect(renderer_->Render(request));
    renderer_->SetObserver(nullptr);
    return counter.Take("wrinkles");
  }
  // Compares the normals of several poses with and without the cache.
  void ExpectSame(MaskMode mode, int rounds) {
    test::SceneProbe probe(head_);
    for (const int size : {512, 160, 48}) {
      for (int round = 0; round < rounds; ++round) {
        Bend();
        const Difference difference =
            Compare(Numbers(probe.Draw(Request(mode, true, size))),
                    Numbers(probe.Draw(Request(mode, false, size))), 0.02);
        EXPECT_LT(difference.mean, size > 100 ? 5e-4 : 1e-3) << size << " " << round;
        EXPECT_LT(difference.share, size > 100 ? 2e-3 : 1e-2) << size << " " << round;
      }
    }
  }
};

TEST_F(SkinnedWrinkleCacheTest, NormalsMatchFragmentsInAnyPose) {
  ExpectSame(MaskMode::kRig, 6);
  ExpectSame(MaskMode::kDynamic, 6);
}

TEST_F(SkinnedWrinkleCacheTest, EveryLambdaIsComposed) {
  for (const auto lambda : {wrinkle::LambdaMode::kBinary, wrinkle::LambdaMode::kLinear}) {
    for (wrinkle::Region& region : head_.rig.regions) region.mask.lambda = lambda;
    Rebuild();
    ExpectSame(MaskMode::kDynamic, 2);
  }
}

TEST_F(SkinnedWrinkleCacheTest, LightAndColourMatchFragments) {
  for (int round = 0; round < 4; ++round) {
    Bend();
    FrameRequest request = Request(MaskMode::kDynamic, true);
    request.settings.view = View::kFinal;
    request.settings.shading = Shading::kSkin;
    request.settings.anti_aliasing.samples = 1;
    request.settings.bloom.strength = 0.0f;
    EXPECT_EQ(Composed(request), 1);
    const Image composed = test::Expect(renderer_->Render(request));
    request.settings.wrinkle_maps.cache = false;
    const Difference difference =
        Compare(composed.rgb, test::Expect(renderer_->Render(request)).rgb, 6.0);
    EXPECT_LT(difference.mean, 0.25) << round;
    EXPECT_LT(difference.share, 2e-3) << round;
  }
}

// Vertices carry no masks for composed wrinkles, so every change of mode or view must restore them.
TEST_F(SkinnedWrinkleCacheTest, ModesAndViewsAlternate) {
  Bend();
  std::map<MaskMode, Image> expected;
  for (const MaskMode mode : {MaskMode::kRig, MaskMode::kTexture, MaskMode::kDynamic}) {
    expected[mode] = test::Expect(renderer_->Render(Request(mode, false)));
  }
  EXPECT_NE(expected[MaskMode::kRig].rgb, expected[MaskMode::kTexture].rgb);
  EXPECT_NE(expected[MaskMode::kRig].rgb, expected[MaskMode::kDynamic].rgb);
  for (int round = 0; round < 3; ++round) {
    for (const auto& [mode, whole] : expected) {
      FrameRequest request = Request(mode, true);
      request.settings.strip.views = {View::kWeights};  // fragments evaluate this view
      (void)test::Expect(renderer_->Render(request));
      request.settings.strip.views.clear();
      const Difference difference =
          Compare(test::Expect(renderer_->Render(request)).rgb, whole.rgb, 6.0);
      EXPECT_LT(difference.mean, 0.25) << round;
    }
  }
}

TEST_F(SkinnedWrinkleCacheTest, AViewOfVertexMasksStillHasThem) {
  Bend();
  FrameRequest request = Request(MaskMode::kRig, true);
  request.settings.view = View::kWeights;
  const Image weights = test::Expect(renderer_->Render(request));
  request.settings.wrinkle_maps.cache = false;
  EXPECT_EQ(test::Expect(renderer_->Render(request)).rgb, weights.rgb);
}

// Both halves of the egg use the same half of the texture.
TEST_F(SkinnedWrinkleCacheTest, MirroredTexturesStayInTheFragment) {
  head_.rig.regions.erase(head_.rig.regions.begin(), head_.rig.regions.begin() + 2);
  for (character::Vertex& vertex : head_.meshes[0].vertices) {
    vertex.uv.x = 0.5f - std::abs(vertex.uv.x - 0.5f);
    const bool left = vertex.position.x > 0.0f;
    for (int i = 0; left && i < 2; ++i) vertex.joints[i] = 1;  // the brow's half is the other one
  }
  Rebuild();
  subject_.pose.joints[2].rotation = glm::angleAxis(1.0f, glm::vec3(1, 0, 0));
  subject_.Solve();
  EXPECT_EQ(Composed(Request(MaskMode::kRig, true)), 0);
  const Image picture = test::Expect(renderer_->Render(Request(MaskMode::kRig, true)));
  EXPECT_EQ(test::Expect(renderer_->Render(Request(MaskMode::kRig, false))).rgb, picture.rgb);
  FrameRequest off = Request(MaskMode::kRig, true);
  off.settings.wrinkles = false;
  EXPECT_NE(test::Expect(renderer_->Render(off)).rgb, picture.rgb);
}

// A sliding mask of a ball joint, next to maps that are composed.
TEST_F(SkinnedWrinkleCacheTest, SlidingMasksStayInTheFragment) {
  wrinkle::Rig& rig = head_.rig;
  wrinkle::Driver ball;
  ball.name = "roll";
  ball.kind = wrinkle::Driver::Kind::kBall;
  ball.ball.parent = "root";
  ball.ball.joint = "head";
  rig.drivers.push_back(ball);
  wrinkle::Region region = rig.regions.back();
  region.name = "slide";
  region.mask = {};
  region.mask.kind = wrinkle::Mask::Kind::kSliding;
  region.mask.driver = "roll";
  region.mask.above = region.mask.below = 4.0f;
  region.mask.radius = 8.0f;
  region.feeds = {{"stretch", {}}};
  for (const char* side : {"front", "back", "left", "right"}) {
    region.feeds[0].sources.push_back({"roll", side, 1.0f});
  }
  rig.regions.push_back(region);
  Rebuild();
  ExpectSame(MaskMode::kRig, 4);
  Bend();
  FrameRequest request = Request(MaskMode::kRig, true);
  const Image sliding = test::Expect(renderer_->Render(request));
  request.settings.mask_mode = MaskMode::kTexture;
  EXPECT_NE(test::Expect(renderer_->Render(request)).rgb, sliding.rgb);
}

}  // namespace
}  // namespace furrow::render
