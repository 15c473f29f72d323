// SPDX-License-Identifier: Apache-2.0
// H.264 pictures of the real daemon over a WebSocket.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pictures_fixture.h"
#include "tests/unit/render/video/bit_reader.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

enum NalType { kSlice = 1, kIdr = 5, kSequenceParameters = 7, kPictureParameters = 8 };

std::vector<int> NalTypes(const std::vector<std::uint8_t>& bytes) {
  std::vector<int> types;
  for (const test::NalUnit& unit : test::SplitNalUnits(bytes)) types.push_back(unit.type);
  return types;
}

class Video : public PicturesTest {
 protected:
  static protocol::SubscribePictures Wish() {
    return {.subject = "ann",
            .width = 96,
            .height = 64,
            .acknowledged = true,
            .settings = {"shading=diffuse"},
            .codecs = {"h264"}};
  }
  std::uint16_t port() const { return *daemon->ready().http; }
  std::uint16_t View(WebClient& viewer, const protocol::SubscribePictures& wish = Wish()) {
    EXPECT_EQ(viewer.Upgrade().status, 101);
    viewer.Send(wish, 0, 1);
    protocol::Header header;
    EXPECT_TRUE(viewer.Take<protocol::SubscribeReply>(&header).has_value());
    return header.stream;
  }
  // Acknowledges the pictures of the next poses, and returns the moving ones.
  std::vector<protocol::ImageFrame> Move(WebClient& viewer, std::uint16_t stream, int count,
                                         bool needs_key = false) {
    std::vector<protocol::ImageFrame> moving;
    while (static_cast<int>(moving.size()) < count) {
      SendPose(frame_++ % 20);
      const auto image = viewer.Await<protocol::ImageFrame>();
      if (!image) break;
      viewer.Send(protocol::FrameAck{.number = image->number, .needs_key = needs_key}, stream);
      if (!image->still) moving.push_back(*image);
    }
    return moving;
  }
  nlohmann::json VideoStatus() const {
    return nlohmann::json::parse(WebClient(port()).Ask("GET", "/api/status").body)["video"];
  }
  // Waits for the daemon's own state, which changes after a connection has closed.
  void AwaitEncoders(int count) const {
    while (VideoStatus()["encoders"] != count) {
    }
  }

 private:
  int frame_ = 0;
};

TEST_F(Video, MovingPicturesAreH264) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  const auto moving = Move(viewer, stream, 4);
  ASSERT_EQ(moving.size(), 4u);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    EXPECT_EQ(moving[i].codec.substr(0, 9), "avc1.42c0") << "constrained baseline";
    EXPECT_EQ(moving[i].width, 96);
    EXPECT_EQ(moving[i].key, i == 0);
    EXPECT_GT(moving[i].received_us, 0);
  }
  EXPECT_EQ(NalTypes(moving[0].bytes),
            (std::vector<int>{kSequenceParameters, kPictureParameters, kIdr}));
  EXPECT_EQ(NalTypes(moving[1].bytes), std::vector<int>{kSlice});
  const auto status = VideoStatus();
  EXPECT_EQ(status["encoders"], 1);
  EXPECT_EQ(status["max_encoders"], 8);
  EXPECT_EQ(status["library"].get<std::string>().substr(0, 8), "OpenH264");
  // Pictures that were encoded before the acknowledgement that asks for a key picture may still come.
  const auto later = Move(viewer, stream, 4, /*needs_key=*/true);
  ASSERT_EQ(later.size(), 4u);
  EXPECT_TRUE(std::ranges::any_of(later, &protocol::ImageFrame::key));
}

TEST_F(Video, APoseAtRestIsJpeg) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  ASSERT_EQ(Move(viewer, stream, 1).size(), 1u);
  std::optional<protocol::ImageFrame> image;
  do {
    image = viewer.Await<protocol::ImageFrame>();
    ASSERT_TRUE(image.has_value());
    viewer.Send(protocol::FrameAck{image->number}, stream);
  } while (!image->still);
  EXPECT_EQ(image->codec, "");
  ASSERT_GE(image->bytes.size(), 2u);
  EXPECT_EQ(image->bytes[0], 0xFF);
  EXPECT_EQ(image->bytes[1], 0xD8);
  const auto moving = Move(viewer, stream, 1);
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_FALSE(moving[0].key) << "the file between changes nothing for the decoder";
}

TEST_F(Video, EncodersGoWithTheirViewers) {
  {
    WebClient first(port());
    WebClient second(port());
    const std::uint16_t first_stream = View(first);
    const std::uint16_t second_stream = View(second);
    // The second viewer acknowledges nothing, and so does not hold up the first one.
    ASSERT_EQ(Move(first, first_stream, 2).size(), 2u);
    AwaitEncoders(2);
    second.Send(protocol::Unsubscribe{}, second_stream);
    AwaitEncoders(1);
  }
  AwaitEncoders(0);
}

TEST_F(Video, AnotherSizeBeginsWithAKey) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  ASSERT_EQ(Move(viewer, stream, 2).size(), 2u);
  protocol::UpdatePictures update{Wish()};
  update.pictures.width = 81;
  viewer.Send(update, stream, 9);
  std::optional<protocol::ImageFrame> first;
  while (!first) {
    const auto moving = Move(viewer, stream, 1);
    ASSERT_FALSE(moving.empty());
    // A picture of the former size, which was already drawn, may still come as a file.
    if (moving[0].width == 81 && !moving[0].codec.empty()) first = moving[0];
  }
  EXPECT_TRUE(first->key);
  EXPECT_EQ(VideoStatus()["encoders"], 1);
}

class WithoutVideo : public Video {
 protected:
  void Configure(server::Config* config) override { config->max_video_encoders = 0; }
};

TEST_F(WithoutVideo, PicturesAreJpegAndTheStatusTellsWhy) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  const auto moving = Move(viewer, stream, 2);
  ASSERT_EQ(moving.size(), 2u);
  for (const protocol::ImageFrame& image : moving) {
    EXPECT_EQ(image.codec, "");
    EXPECT_EQ(image.bytes.at(0), 0xFF);
  }
  EXPECT_EQ(VideoStatus()["why"], "render.max_video_encoders is 0");
}

class OneEncoder : public Video {
 protected:
  void Configure(server::Config* config) override { config->max_video_encoders = 1; }
};

TEST_F(OneEncoder, FurtherViewersGetJpeg) {
  WebClient first(port());
  WebClient second(port());
  const std::uint16_t first_stream = View(first);
  ASSERT_EQ(Move(first, first_stream, 1).at(0).codec.substr(0, 4), "avc1");
  const std::uint16_t second_stream = View(second);
  const auto files = Move(second, second_stream, 2);
  ASSERT_EQ(files.size(), 2u);
  for (const protocol::ImageFrame& image : files) EXPECT_EQ(image.codec, "");
  first.Send(protocol::Unsubscribe{}, first_stream);
  AwaitEncoders(0);
  const auto moving = Move(second, second_stream, 2);
  ASSERT_EQ(moving.size(), 2u);
  EXPECT_EQ(moving.back().codec.substr(0, 4), "avc1") << "as soon as the encoder is free";
}

}  // namespace
}  // namespace furrow::testing_net
