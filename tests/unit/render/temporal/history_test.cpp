// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/history.h"

#include <gtest/gtest.h>

#include "tests/unit/render/null_device.h"

namespace furrow::render {
namespace {

FrameRequest Moving(std::uint64_t stream, int width = 640, int height = 400) {
  FrameRequest request;
  request.settings.shading = Shading::kSkin;
  request.width = width;
  request.height = height;
  request.is_moving = true;
  request.stream = stream;
  request.scale = 0.5f;
  return request;
}

class HistoriesTest : public testing::Test {
 protected:
  // Draws a picture. Returns whether it could continue a former one.
  bool Draw(const FrameRequest& request) {
    const TemporalFrame* frame = histories_.Begin(request, true);
    if (frame == nullptr) return false;
    const bool continues = frame->former_colour.texture != 0;
    EXPECT_EQ(continues, frame->former_place.texture != 0);
    EXPECT_NE(frame->former_colour.texture, frame->colour.texture);
    histories_.End(request, {});
    return continues;
  }
  test::NullDevice device_;
  Histories histories_{&device_};
};

TEST_F(HistoriesTest, TheSecondPictureOfAStreamContinuesTheFirst) {
  EXPECT_FALSE(Draw(Moving(1)));
  EXPECT_TRUE(Draw(Moving(1)));
  EXPECT_TRUE(Draw(Moving(1)));
}

TEST_F(HistoriesTest, EverySecondPictureKeepsTheShadowMapsThatTheFormerOneHasDrawn) {
  for (const bool is_drawn : {true, false, true, true}) {
    for (const bool keeps : {false, is_drawn}) {
      const TemporalFrame* frame = histories_.Begin(Moving(1), true);
      ASSERT_NE(frame, nullptr);
      EXPECT_EQ(frame->keeps_shadows, keeps);
      EXPECT_EQ(MotionOf(*frame).shadows != nullptr, keeps);
      if (!keeps) frame->history->shadows.is_drawn = is_drawn;
      histories_.End(Moving(1), {});
      std::array<ShadowView, kNumLights> views;
      views[0].scale = keeps ? 3.0f : 2.0f;
      histories_.KeepShadows(views, 256);
      if (is_drawn) EXPECT_EQ(frame->history->shadows.views[0].scale, 2.0f);
    }
  }
  const FrameRequest cut = Moving(1, 320, 200);
  EXPECT_FALSE(Draw(cut));
  EXPECT_FALSE(histories_.Begin(cut, true)->keeps_shadows);
}

TEST_F(HistoriesTest, StreamsShareNothing) {
  EXPECT_FALSE(Draw(Moving(1)));
  EXPECT_FALSE(Draw(Moving(2)));
  EXPECT_TRUE(Draw(Moving(1)));
}

TEST_F(HistoriesTest, ACutBeginsAgain) {
  EXPECT_FALSE(Draw(Moving(1)));
  EXPECT_TRUE(Draw(Moving(1)));
  FrameRequest cut = Moving(1);
  cut.settings.exposure = 2.0f;
  const TemporalFrame* frame = histories_.Begin(cut, true);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->former_colour.texture, 0u);
  EXPECT_EQ(frame->history->number, 0) << "the jitter, too";
  EXPECT_TRUE(frame->history->vertices.meshes.empty());
  EXPECT_EQ(MotionOf(*frame).camera, nullptr);
}

TEST_F(HistoriesTest, ThePictureMayChangeItsScaleWithoutACut) {
  EXPECT_FALSE(Draw(Moving(1)));
  FrameRequest finer = Moving(1);
  finer.scale = 0.75f;
  const TemporalFrame* frame = histories_.Begin(finer, true);
  ASSERT_NE(frame, nullptr);
  EXPECT_NE(frame->former_colour.texture, 0u);
  EXPECT_EQ(frame->width, 480);
  EXPECT_EQ(frame->height, 300);
  EXPECT_EQ(frame->former_place.desc.width, 320);
}

TEST_F(HistoriesTest, APictureThatFailedLeavesTheHistoryAlone) {
  EXPECT_FALSE(Draw(Moving(1)));
  const TemporalFrame* frame = histories_.Begin(Moving(1), true);
  ASSERT_NE(frame, nullptr);
  const TextureId former = frame->former_colour.texture;
  const glm::vec2 jitter = frame->jitter;
  frame = histories_.Begin(Moving(1), true);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->former_colour.texture, former);
  EXPECT_EQ(frame->jitter, jitter);
}

TEST_F(HistoriesTest, MemoryIsBoundedAndFirstStreamsKeepTheirHistories) {
  int num_completed = 0;
  for (int turn = 0; turn < 3; ++turn) {
    num_completed = 0;
    for (std::uint64_t stream = 1; stream < 50; ++stream) {
      const bool continues = Draw(Moving(stream, 1280, 720));
      num_completed += continues ? 1 : 0;
      EXPECT_EQ(continues, turn > 0 && stream <= 4) << stream;
      ASSERT_LE(histories_.num_bytes(), Histories::kMaxBytes);
    }
  }
  EXPECT_EQ(num_completed, 4) << "the others are drawn in full";
  EXPECT_EQ(device_.num_bad_destroys(), 0);
}

// The bound holds whatever the scales become.
TEST_F(HistoriesTest, RoomDoesNotDependOnTheScale) {
  for (const float scale : {0.5f, 0.9f}) {
    for (std::uint64_t stream = 1; stream < 10; ++stream) {
      for (int picture = 0; picture < 2; ++picture) {
        FrameRequest request = Moving(stream, 1280, 720);
        request.scale = scale;
        (void)Draw(request);
        ASSERT_LE(histories_.num_bytes(), Histories::kMaxBytes);
      }
    }
  }
  EXPECT_TRUE(Draw(Moving(1, 1280, 720)));
}

TEST_F(HistoriesTest, VerticesCount) {
  const TemporalFrame* frame = histories_.Begin(Moving(1), true);
  ASSERT_NE(frame, nullptr);
  frame->history->vertices.meshes[0].capacity = Histories::kMaxBytes / 2;
  histories_.End(Moving(1), {});
  EXPECT_EQ(histories_.Begin(Moving(2), true), nullptr) << "it would need as many";
  EXPECT_TRUE(Draw(Moving(1)));
}

TEST_F(HistoriesTest, ANewSizeReleasesTheOldPair) {
  for (int picture = 0; picture < 2; ++picture) (void)Draw(Moving(1, 1280, 720));
  (void)Draw(Moving(1));
  const std::size_t pixels = 640 * 400 + 320 * 200;
  EXPECT_EQ(histories_.num_bytes(), 8 * pixels);
}

TEST_F(HistoriesTest, AStreamThatRestsLosesItsHistory) {
  (void)Draw(Moving(1));
  for (int picture = 0; picture < 2; ++picture) (void)Draw(Moving(2));
  const std::size_t both = histories_.num_bytes();
  for (std::uint64_t i = 2; i < Histories::kMaxRest; ++i) EXPECT_TRUE(Draw(Moving(2)));
  EXPECT_EQ(histories_.num_bytes(), both);
  EXPECT_TRUE(Draw(Moving(2)));
  EXPECT_LT(histories_.num_bytes(), both);
  EXPECT_FALSE(Draw(Moving(1)));
}

TEST_F(HistoriesTest, AFullPictureEndsTheHistoryOfItsStream) {
  (void)Draw(Moving(1));
  FrameRequest full = Moving(1);
  full.scale = 1.0f;
  EXPECT_EQ(histories_.Begin(full, true), nullptr);
  EXPECT_EQ(histories_.num_bytes(), 0u);
  EXPECT_FALSE(Draw(Moving(1)));
}

TEST_F(HistoriesTest, APictureThatIsTooLargeStandsAlone) {
  EXPECT_EQ(histories_.Begin(Moving(1, 4096, 4096), true), nullptr);
  EXPECT_EQ(histories_.num_bytes(), 0u);
}

TEST_F(HistoriesTest, ReleasesItsTextures) {
  {
    Histories histories(&device_);
    ASSERT_NE(histories.Begin(Moving(1), true), nullptr);
  }
  EXPECT_EQ(device_.num_alive(), 0);
}

}  // namespace
}  // namespace furrow::render
