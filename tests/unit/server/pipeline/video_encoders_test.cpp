// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/video_encoders.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/unit/server/pipeline/fake_video.h"

namespace furrow::server {
namespace {

using test::fake_video;

constexpr render::VideoFormat kFormat{64, 32, 80};

class VideoEncodersTest : public testing::Test {
 protected:
  void SetUp() override { fake_video = {}; }
  static render::Planes PlanesOf(int width, int height) {
    return {.width = width, .height = height};
  }
  VideoEncoders encoders{test::FakeVideoCodec(), 8};
};

TEST_F(VideoEncodersTest, EachSubscriptionHasItsOwn) {
  ASSERT_TRUE(encoders.Open(1, "a", kFormat));
  ASSERT_TRUE(encoders.Open(2, "b", kFormat));
  ASSERT_TRUE(encoders.Open(1, "a", kFormat)) << "keeps its place";
  EXPECT_EQ(encoders.state().encoders, 2);
  EXPECT_EQ(encoders.state().library, "fake 1.0");
  for (const std::uint64_t subscription : {1, 2, 1}) {
    ASSERT_TRUE(encoders.Encode(subscription, PlanesOf(64, 32), {}).ok());
  }
  EXPECT_EQ(fake_video.made, 2);
  const auto delta = encoders.Encode(1, PlanesOf(64, 32), {});
  ASSERT_TRUE(delta.ok());
  EXPECT_FALSE(delta->key);
  EXPECT_EQ(delta->codec, "avc1.42c01e") << "of the key picture before it";
  EXPECT_TRUE(encoders.Encode(1, PlanesOf(64, 32), {.key = true})->key);
}

TEST_F(VideoEncodersTest, AnEncoderGoesWithItsViewer) {
  ASSERT_TRUE(encoders.Open(1, "a", kFormat));
  ASSERT_TRUE(encoders.Encode(1, PlanesOf(64, 32), {}).ok());
  EXPECT_EQ(fake_video.alive, 1);
  encoders.Close(1);
  EXPECT_EQ(fake_video.alive, 0) << "nobody else encodes";
  EXPECT_EQ(encoders.state().encoders, 0);
  EXPECT_EQ(encoders.Encode(1, PlanesOf(64, 32), {}).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(fake_video.made, 1) << "a picture that comes late makes no encoder";
  encoders.Close(1);  // nothing to do
}

TEST_F(VideoEncodersTest, AnotherFormatIsAnotherEncoder) {
  ASSERT_TRUE(encoders.Open(1, "a", kFormat));
  ASSERT_TRUE(encoders.Encode(1, PlanesOf(64, 32), {}).ok());
  ASSERT_TRUE(encoders.Open(1, "a", {128, 64, 80}));
  EXPECT_EQ(encoders.Encode(1, PlanesOf(64, 32), {}).status().code(), StatusCode::kNotFound)
      << "a picture of the former size";
  EXPECT_TRUE(encoders.Encode(1, PlanesOf(128, 64), {})->key);
  EXPECT_EQ(fake_video.alive, 1);
  ASSERT_TRUE(encoders.Open(1, "a", {128, 64, 60}));
  EXPECT_TRUE(encoders.Encode(1, PlanesOf(128, 64), {})->key) << "another quality";
}

TEST_F(VideoEncodersTest, TheirNumberIsLimitedAndShared) {
  int greedy = 0;
  for (std::uint64_t i = 0; i < 100; ++i) greedy += encoders.Open(i, "greedy", kFormat) ? 1 : 0;
  EXPECT_EQ(greedy, 4) << "half of the places";
  EXPECT_TRUE(encoders.Open(200, "other", kFormat));
  encoders.Close(0);
  EXPECT_TRUE(encoders.Open(201, "third", kFormat));
  EXPECT_EQ(encoders.state().encoders, 5);
  VideoEncoders none(nullptr, 8, "no library");
  EXPECT_FALSE(none.Open(1, "a", kFormat));
  EXPECT_EQ(none.state().why, "no library");
  EXPECT_EQ(none.state().max_encoders, 0);
}

TEST_F(VideoEncodersTest, TheirMemoryIsLimitedAndShared) {
  VideoEncoders many(test::FakeVideoCodec(), 1000);
  constexpr render::VideoFormat kLarge{1024, 1024, 80};
  const std::size_t fits = VideoEncoders::kMaxBytes / render::VideoEncoderBytes(1024, 1024);
  std::size_t opened = 0;
  for (std::uint64_t i = 0; i < 100; ++i) opened += many.Open(i, "a", kLarge) ? 1 : 0;
  EXPECT_EQ(opened, (fits + 1) / 2) << "half of it, as of the places";
  EXPECT_TRUE(many.Open(200, "b", kLarge)) << "a newcomer finds room";
  EXPECT_TRUE(many.Open(0, "a", kFormat)) << "a smaller one takes its own place";
  const int held = many.state().encoders;
  EXPECT_FALSE(many.Open(0, "a", {4096, 4096, 80}));
  EXPECT_EQ(many.state().encoders, held - 1) << "a viewer without video holds no place";
  many.Close(1);
  EXPECT_TRUE(many.Open(100, "a", kLarge)) << "memory is given back";
}

// Freeing an encoder takes milliseconds, in which no pose could be handled.
TEST_F(VideoEncodersTest, EncodersOfViewersThatLeftAreFreedWhereOthersEncode) {
  for (const std::uint64_t viewer : {1, 2}) {
    ASSERT_TRUE(encoders.Open(viewer, "a", kFormat));
    ASSERT_TRUE(encoders.Encode(viewer, PlanesOf(64, 32), {}).ok());
  }
  encoders.Close(1);
  EXPECT_EQ(fake_video.alive, 2);
  ASSERT_TRUE(encoders.Encode(2, PlanesOf(64, 32), {}).ok());
  EXPECT_EQ(fake_video.alive, 1);
}

TEST_F(VideoEncodersTest, AVideoBeginsAgainAfterALostPicture) {
  ASSERT_TRUE(encoders.Open(1, "a", kFormat));
  ASSERT_TRUE(encoders.Encode(1, PlanesOf(64, 32), {})->key);
  EXPECT_FALSE(encoders.Encode(1, PlanesOf(64, 32), {})->key);
  encoders.Restart(1);
  EXPECT_TRUE(encoders.Encode(1, PlanesOf(64, 32), {})->key);
  encoders.Restart(7);  // nothing to do
}

TEST_F(VideoEncodersTest, AFailedEncoderGetsNoMorePictures) {
  fake_video.fails_after = 2;
  ASSERT_TRUE(encoders.Open(1, "a", kFormat));
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(encoders.Encode(1, PlanesOf(64, 32), {}).ok());
  EXPECT_EQ(encoders.Encode(1, PlanesOf(64, 32), {}).status().code(), StatusCode::kInternal);
  EXPECT_EQ(fake_video.alive, 0);
  EXPECT_EQ(encoders.Encode(1, PlanesOf(64, 32), {}).status().code(), StatusCode::kNotFound);
  EXPECT_FALSE(encoders.Open(1, "a", kFormat)) << "its viewer gets files";
  EXPECT_TRUE(encoders.Open(1, "a", {128, 64, 80})) << "another size may work";
  fake_video.cannot_make = true;
  EXPECT_EQ(encoders.Encode(1, PlanesOf(128, 64), {}).status().what(), "no fake encoder");
}

}  // namespace
}  // namespace furrow::server
