// SPDX-License-Identifier: Apache-2.0
// Pictures over TCP, rendered from the received poses. Needs OpenGL 4.5 (llvmpipe is enough).
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "pictures_fixture.h"

namespace furrow::testing_net {
namespace {

using protocol::ErrorCode;
using server::Counter;

class Pictures : public PicturesTest {
 protected:
  void SetUp() override {
    PicturesTest::SetUp();
    if (sender) viewer.emplace(daemon->ready().tcp);
  }

  std::optional<TcpClient> viewer;
};

TEST_F(Pictures, HaveTheRequestedSizeAndFormat) {
  for (const auto format : {protocol::ImageFormat::kJpeg, protocol::ImageFormat::kPng}) {
    TcpClient client(daemon->ready().tcp);
    client.Send(
        protocol::SubscribePictures{.subject = "ann", .width = 96, .height = 64, .format = format},
        0, 1);
    ASSERT_TRUE(client.Await<protocol::SubscribeReply>().has_value());
    const int frame = format == protocol::ImageFormat::kJpeg ? 3 : 4;
    SendPose(frame);
    const auto image = client.Await<protocol::ImageFrame>();
    ASSERT_TRUE(image.has_value());
    EXPECT_EQ(image->width, 96);
    EXPECT_EQ(image->height, 64);
    EXPECT_EQ(image->format, format);
    ASSERT_GT(image->bytes.size(), 100u);
    EXPECT_EQ(image->bytes[0], format == protocol::ImageFormat::kJpeg ? 0xFF : 0x89);
  }
}

TEST_F(Pictures, ShowThePose) {
  viewer->Send(
      protocol::SubscribePictures{
          .subject = "ann", .width = 64, .height = 64, .format = protocol::ImageFormat::kPng},
      0, 1);
  ASSERT_TRUE(viewer->Await<protocol::SubscribeReply>().has_value());
  std::optional<protocol::ImageFrame> last;
  for (int frame = 0; frame < 3; ++frame) {
    SendPose(frame * 5);
    protocol::Header header;
    auto image = viewer->Await<protocol::ImageFrame>(&header);
    ASSERT_TRUE(image.has_value());
    ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame * 5));
    ASSERT_EQ(header.capture_time_us, frame * 5000);
    if (last) {
      EXPECT_NE(last->bytes, image->bytes) << "the head has nodded";
    }
    last = std::move(image);
  }
}

TEST_F(Pictures, EqualRequestsAreRenderedOnce) {
  TcpClient second(daemon->ready().tcp);
  const protocol::SubscribePictures wish{.subject = "ann", .width = 64, .height = 64};
  for (TcpClient* client : {&*viewer, &second}) {
    client->Send(wish, 0, 1);
    ASSERT_TRUE(client->Await<protocol::SubscribeReply>().has_value());
  }
  SendPose(1);
  const auto a = viewer->Await<protocol::ImageFrame>();
  const auto b = second.Await<protocol::ImageFrame>();
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_EQ(a->bytes, b->bytes);
  EXPECT_EQ(daemon->Count(Counter::kPicturesRendered), 1u);
  EXPECT_EQ(daemon->Count(Counter::kPicturesEncoded), 1u);
  EXPECT_EQ(daemon->Count(Counter::kPicturesSent), 2u);
}

TEST_F(Pictures, EveryViewAndPresetRenders) {
  std::uint32_t request = 1;
  for (const char* view :
       {"final", "normal", "mask_dynamic", "mask_texture", "weights", "wireframe"}) {
    viewer->Send(
        protocol::SubscribePictures{
            .subject = "ann", .width = 64, .height = 64, .view = view, .camera_preset = "body"},
        0, request++);
    ASSERT_TRUE(viewer->Await<protocol::SubscribeReply>().has_value()) << view;
  }
  SendPose(1);
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(viewer->Await<protocol::ImageFrame>().has_value());
  viewer->Send(protocol::SubscribePictures{.subject = "ann", .view = "xray"}, 0, request++);
  EXPECT_EQ(viewer->Await<protocol::ErrorMessage>()->code, ErrorCode::kBadPicture);
  viewer->Send(protocol::SubscribePictures{.subject = "ann", .camera_preset = "moon"}, 0,
               request++);
  EXPECT_EQ(viewer->Await<protocol::ErrorMessage>()->code, ErrorCode::kBadPicture);
}

TEST_F(Pictures, ABurstOfPosesShowsTheNewest) {
  viewer->Send(protocol::SubscribePictures{.subject = "ann", .width = 640, .height = 480}, 0, 1);
  ASSERT_TRUE(viewer->Await<protocol::SubscribeReply>().has_value());
  for (int frame = 0; frame < 20; ++frame) SendPose(frame);
  std::int64_t newest = -1;
  int count = 0;
  while (newest < 19) {
    protocol::Header header;
    ASSERT_TRUE(viewer->Await<protocol::ImageFrame>(&header).has_value());
    ASSERT_GT(static_cast<std::int64_t>(header.sequence), newest);
    newest = header.sequence;
    ++count;
  }
  EXPECT_EQ(daemon->Count(Counter::kSnapshotsReplaced) + daemon->Count(Counter::kPicturesRendered),
            20u);
  EXPECT_LE(count, 20);
}

// A picture of 64x64 is 0.054 megapixels with its meshes, so one per second is paid for.
class PicturesWithABudget : public Pictures {
 protected:
  void Configure(server::Config* config) override { config->max_host_megapixels_per_second = 0.05; }
};

TEST_F(PicturesWithABudget, ComeLater) {
  viewer->Send(protocol::SubscribePictures{.subject = "ann", .width = 64, .height = 64}, 0, 1);
  ASSERT_TRUE(viewer->Await<protocol::SubscribeReply>().has_value());
  // A picture that takes longer than a second to draw is paid for when it is done.
  int frame = 0;
  while (frame < 20 && daemon->Count(Counter::kPicturesHeld) == 0) {
    SendPose(frame++);
    protocol::Header header;
    ASSERT_TRUE(viewer->Await<protocol::ImageFrame>(&header).has_value());
    EXPECT_EQ(header.sequence, static_cast<std::uint32_t>(frame - 1));
  }
  EXPECT_EQ(daemon->Count(Counter::kPicturesHeld), 1u);
  EXPECT_EQ(daemon->Count(Counter::kPicturesRendered), static_cast<std::uint64_t>(frame));
}

}  // namespace
}  // namespace furrow::testing_net
