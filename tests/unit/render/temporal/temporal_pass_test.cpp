// SPDX-License-Identifier: Apache-2.0
// Pictures of streams, drawn.
#include "render/temporal/temporal_pass.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/reference/target_reader.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kSize = 128;

class TemporalPassTest : public testing::Test {
 protected:
  void SetUp() override {
    renderer_ = test::Expect(Renderer::Create(head_));
    if (!renderer_->is_software()) GTEST_SKIP() << "a GPU draws all pixels of every picture";
  }
  FrameRequest Request(std::uint64_t stream) {
    FrameRequest request;
    request.model = subject_.model;
    request.settings.shading = Shading::kSkin;
    request.camera = *renderer_->Preset("face");
    request.camera.follow_joint = -1;
    request.width = request.height = kSize;
    request.is_moving = true;
    request.stream = stream;
    request.scale = 0.5f;
    return request;
  }
  Image Draw(const FrameRequest& request) { return test::Expect(renderer_->Render(request)); }
  Image Draw(std::uint64_t stream) { return Draw(Request(stream)); }
  void Move(float metres) {
    for (glm::mat4& joint : subject_.model) joint[3].x += metres;
  }
  Image Exact() {
    FrameRequest request = Request(0);
    request.is_moving = false;
    request.settings.anti_aliasing.samples = 4;
    return Draw(request);
  }
  static double Rmse(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
      const double difference = static_cast<double>(a.rgb[i]) - b.rgb[i];
      sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(a.rgb.size()));
  }

  character::Character head_ = test::MakeHead();
  test::Subject subject_{head_};
  std::unique_ptr<Renderer> renderer_;
};

TEST_F(TemporalPassTest, AStaticSceneConvergesToTheFullPicture) {
  const Image exact = Exact();
  const Image first = Draw(1);
  Image image;
  for (int picture = 0; picture < 24; ++picture) image = Draw(1);
  EXPECT_EQ(image.width, kSize);
  EXPECT_EQ(image.height, kSize);
  EXPECT_EQ(image.drawn_percent, 50);
  EXPECT_LT(Rmse(image, exact), 0.75 * Rmse(first, exact));
}

TEST_F(TemporalPassTest, AMovingSubjectIsNotBlurred) {
  Image image;
  Image first;
  for (int picture = 0; picture < 12; ++picture) {
    Move(0.0005f);
    image = Draw(1);
    first = Draw(100 + static_cast<std::uint64_t>(picture));  // without former pictures
  }
  EXPECT_LT(Rmse(image, Exact()), Rmse(first, Exact()));
}

// The motion of the middle of the picture: where the former picture showed it, pixels to the right
// and up.
glm::vec2 MotionAtCentre(const test::TargetReader& reader) {
  const test::FloatPicture& motion = reader.Target("scene motion");
  return 0.5f * kSize * glm::vec2(motion.At(motion.width / 2, motion.height / 2));
}

TEST_F(TemporalPassTest, MotionIsThatOfJointsAndOfTheCamera) {
  constexpr float kMetres = 0.01f;
  test::TargetReader reader;
  const auto draw = [&](const FrameRequest& request) {
    renderer_->SetObserver(&reader);
    (void)Draw(request);
    renderer_->SetObserver(nullptr);
    return MotionAtCentre(reader);
  };
  (void)Draw(1);
  EXPECT_NEAR(glm::length(draw(Request(1))), 0.0f, 0.05f);
  Move(kMetres);
  const glm::vec2 by_joints = draw(Request(1));
  EXPECT_LT(by_joints.x, -3.0f) << "the subject was farther to the left";
  EXPECT_GT(by_joints.x, -12.0f);
  EXPECT_NEAR(by_joints.y, 0.0f, 0.05f);
  FrameRequest beside = Request(1);
  beside.camera.position.x += kMetres;
  beside.camera.target.x += kMetres;
  const glm::vec2 by_camera = draw(beside);
  EXPECT_NEAR(by_camera.x, -by_joints.x, 0.1f);
  EXPECT_NEAR(by_camera.y, 0.0f, 0.05f);
  // Both together: the picture stays as it was.
  Move(kMetres);
  beside.camera.position.x += kMetres;
  beside.camera.target.x += kMetres;
  EXPECT_NEAR(glm::length(draw(beside)), 0.0f, 0.05f);
}

// The place that the subject has left shows the background at once.
TEST_F(TemporalPassTest, ASubjectThatJumpsLeavesNoGhost) {
  for (int picture = 0; picture < 8; ++picture) (void)Draw(1);
  const Image before = Exact();
  Move(0.12f);  // half its width
  const Image image = Draw(1);
  const Image after = Exact();
  const auto is_even = [](const Image& picture, int x, int y) {
    const auto at = [&](int column, int row) {
      return picture.rgb[static_cast<std::size_t>(3 * (row * kSize + column))];
    };
    for (int i = 0; i < 49; ++i) {
      if (at(x + i % 7 - 3, y + i / 7 - 3) != at(0, 0)) return false;
    }
    return true;
  };
  int num_left = 0;
  for (int y = 3; y < kSize - 3; ++y) {
    for (int x = 3; x < kSize - 3; ++x) {
      if (is_even(before, x, y) || !is_even(after, x, y)) continue;
      ++num_left;
      const auto pixel = static_cast<std::size_t>(3 * (y * kSize + x));
      ASSERT_NEAR(image.rgb[pixel], after.rgb[0], 2) << x << " " << y;
    }
  }
  EXPECT_GT(num_left, 500);
}

TEST_F(TemporalPassTest, ACutShowsNothingOfTheFormerPicture) {
  for (int picture = 0; picture < 5; ++picture) (void)Draw(1);
  FrameRequest request = Request(1);
  request.settings.exposure = 0.3f;
  const Image cut = Draw(request);
  request.stream = 2;
  EXPECT_EQ(cut.rgb, Draw(request).rgb) << "the same as the first picture of a new stream";
}

TEST_F(TemporalPassTest, StreamsDoNotAffectEachOther) {
  std::vector<Image> alone;
  for (int picture = 0; picture < 4; ++picture) alone.push_back(Draw(1));
  for (int picture = 0; picture < 4; ++picture) {
    EXPECT_EQ(Draw(2).rgb, alone[static_cast<std::size_t>(picture)].rgb) << picture;
    Move(0.05f);
    (void)Draw(3);
    (void)Exact();
    Move(-0.05f);
  }
}

TEST_F(TemporalPassTest, OtherPicturesDoNotDependOnHistories) {
  const Image exact = Exact();
  FrameRequest still = Request(1);
  still.is_moving = false;
  const Image before = Draw(still);
  EXPECT_EQ(before.drawn_percent, 100);
  for (int picture = 0; picture < 3; ++picture) (void)Draw(1);
  EXPECT_EQ(Draw(still).rgb, before.rgb);
  EXPECT_EQ(Exact().rgb, exact.rgb);
}

class PassNames final : public FrameGraphObserver {
 public:
  [[nodiscard]] bool has(std::string_view name) const {
    return std::ranges::find(names_, name) != names_.end();
  }
  void BeforePass(std::string_view name) override { names_.emplace_back(name); }
  void AfterPass(std::string_view, const std::vector<Written>&) override {}

 private:
  std::vector<std::string> names_;
};

TEST_F(TemporalPassTest, OnlyPicturesWithoutAFormerOneNeedFxaa) {
  const auto smooths = [this](const FrameRequest& request) {
    PassNames names;
    renderer_->SetObserver(&names);
    (void)Draw(request);
    renderer_->SetObserver(nullptr);
    EXPECT_TRUE(names.has("accumulate"));
    return names.has("fxaa");
  };
  EXPECT_TRUE(smooths(Request(1)));
  EXPECT_FALSE(smooths(Request(1)));
  FrameRequest cut = Request(1);
  cut.settings.exposure = 0.3f;
  EXPECT_TRUE(smooths(cut));
  EXPECT_FALSE(smooths(cut));
}

TEST_F(TemporalPassTest, EverySecondPictureUsesTheShadowMapsOfTheFormerOne) {
  const auto draws_shadows = [this](const FrameRequest& request) {
    PassNames names;
    renderer_->SetObserver(&names);
    (void)Draw(request);
    renderer_->SetObserver(nullptr);
    return names.has("shadows");
  };
  EXPECT_TRUE(draws_shadows(Request(1)));
  EXPECT_FALSE(draws_shadows(Request(1)));
  EXPECT_TRUE(draws_shadows(Request(2))) << "each stream has maps of its own";
  EXPECT_TRUE(draws_shadows(Request(1)));
  EXPECT_FALSE(draws_shadows(Request(1)));
  EXPECT_FALSE(draws_shadows(Request(2)));
  FrameRequest cut = Request(1);
  cut.settings.exposure = 0.3f;
  EXPECT_TRUE(draws_shadows(cut));
  FrameRequest large = Request(3);
  large.settings.shadow.fit = false;
  large.settings.shadow.resolution = 2048;
  EXPECT_TRUE(draws_shadows(large));
  Move(0.01f);
  EXPECT_TRUE(draws_shadows(large)) << "large maps are not kept";
}

// Subject, camera and lamps move together, so the picture stays, if each surface finds its place in
// the shadow maps of the former picture.
TEST_F(TemporalPassTest, FormerShadowsMoveWithTheSurface) {
  FrameRequest moving = Request(1);
  for (int picture = 0; picture < 6; ++picture) {
    const Image stays = Draw(2);
    FrameRequest still = Request(2);
    Move(0.02f * static_cast<float>(picture));
    moving.camera.position.x = still.camera.position.x + 0.02f * static_cast<float>(picture);
    moving.camera.target.x = still.camera.target.x + 0.02f * static_cast<float>(picture);
    EXPECT_LT(Rmse(Draw(moving), stays), 0.5) << "picture " << picture;
    Move(-0.02f * static_cast<float>(picture));
  }
}

TEST_F(TemporalPassTest, AFullPictureIsThatOfNoStream) {
  FrameRequest request = Request(1);
  request.scale = 1.0f;
  const Image full = Draw(request);
  EXPECT_EQ(full.drawn_percent, 100);
  request.stream = 0;
  EXPECT_EQ(full.rgb, Draw(request).rgb);
}

// Ends a frame after some passes.
class Quitter final : public FrameGraphObserver {
 public:
  explicit Quitter(int passes) : left_(passes) {}
  bool Continues() override { return left_-- > 0; }
  void BeforePass(std::string_view) override {}
  void AfterPass(std::string_view, const std::vector<Written>&) override {}

 private:
  int left_;
};

TEST_F(TemporalPassTest, AnAbandonedPictureLeavesNoTrace) {
  for (const std::uint64_t stream : {1, 2}) (void)Draw(stream);
  int passes = 0;
  for (bool is_complete = false; !is_complete; ++passes) {
    ASSERT_LT(passes, 100);
    Quitter quitter(passes);
    Move(0.02f);
    renderer_->SetObserver(&quitter);
    const StatusCode code = renderer_->Submit(Request(1)).code();
    renderer_->SetObserver(nullptr);
    Move(-0.02f);
    is_complete = code == StatusCode::kOk;
    if (is_complete) break;
    ASSERT_EQ(code, StatusCode::kUnavailable);
    ASSERT_EQ(Draw(1).rgb, Draw(2).rgb) << "after " << passes << " passes";
  }
  EXPECT_GT(passes, 5);
}

}  // namespace
}  // namespace furrow::render
