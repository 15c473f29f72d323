// SPDX-License-Identifier: Apache-2.0
// Pictures of streams, drawn.
#include "render/temporal/temporal_pass.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "render/renderer.h"
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

// Ends a frame after some passes.
class Quitter final : public FrameGraphObserver {
 public:
  bool Continues() override { return --left_ > 0; }
  void BeforePass(std::string_view) override {}
  void AfterPass(std::string_view, const std::vector<Written>&) override {}

 private:
  int left_ = 5;
};

TEST_F(TemporalPassTest, AnAbandonedPictureLeavesNoTrace) {
  for (const std::uint64_t stream : {1, 2}) (void)Draw(stream);
  Quitter quitter;
  Move(0.02f);
  renderer_->SetObserver(&quitter);
  EXPECT_EQ(renderer_->Submit(Request(1)).code(), StatusCode::kUnavailable);
  renderer_->SetObserver(nullptr);
  Move(-0.02f);
  EXPECT_EQ(Draw(1).rgb, Draw(2).rgb);
}

}  // namespace
}  // namespace furrow::render
