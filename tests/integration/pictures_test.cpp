// SPDX-License-Identifier: Apache-2.0
// Pictures over TCP: drawn from the poses that crossed the socket. Needs an OpenGL 4.5 (llvmpipe
// does).
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "character/character.h"
#include "daemon_fixture.h"
#include "motion/pose_source.h"

namespace furrow::testing_net {
namespace {

using protocol::ErrorCode;
using server::Counter;

// A clip of the default character itself: its head nods on, frame by frame. (Cameras follow where a
// subject goes and turns, so a turn of the whole body would not show.)
motion::Clip NoddingClip(const character::Character& character, int num_frames) {
  motion::Clip clip;
  clip.skeleton = character.skeleton;
  const auto rest = character.skeleton.rest_pose();
  const int head = character.skeleton.Find("head");
  EXPECT_NE(head, wrinkle::kNoJoint);
  for (int frame = 0; frame < num_frames; ++frame) {
    clip.times.push_back(frame / 30.0);
    for (int j = 0; j < character.skeleton.num_joints(); ++j) {
      clip.locals.push_back(rest[j]);
      if (j == head) {
        clip.locals.back().rotation =
            glm::angleAxis(0.05f * static_cast<float>(frame), glm::vec3(1, 0, 0)) *
            clip.locals.back().rotation;
      }
    }
  }
  return clip;
}

class Pictures : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path glb =
        std::filesystem::path(FURROW_BINARY_DIR) / "share" / "furrow" / "default.glb";
    if (!std::filesystem::exists(glb)) GTEST_SKIP() << "no " << glb << ": build furrow_share";
    server::Config config;
    config.character = glb;
    config.tcp = config.udp = 0;
    config.http.port = 0;
    // However slowly pictures are drawn here, only poses ask for them, never a subject's decay.
    config.limits.loss_seconds = config.limits.idle_seconds = 3600;
    auto loaded = character::LoadCharacter(glb, {}, motion::CachedPoseSource());
    ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
    clip = NoddingClip(*loaded, 20);
    daemon.emplace(config);
    ASSERT_TRUE(daemon->serves());
    if (!daemon->ready().render) GTEST_SKIP() << "no OpenGL 4.5 here";
    sender.emplace(daemon->ready().tcp);
    viewer.emplace(daemon->ready().tcp);
    offer = OfferOf(clip, "ann");
    Offer(*sender, offer);
  }
  void SendPose(int frame) {
    sender->Send(PoseOf(clip, frame, offer), 1, static_cast<std::uint32_t>(frame),
                 1000 * static_cast<std::int64_t>(frame));
  }

  motion::Clip clip;
  protocol::SkeletonOffer offer;
  std::optional<DaemonThread> daemon;
  std::optional<TcpClient> sender;
  std::optional<TcpClient> viewer;
};

TEST_F(Pictures, AreOfTheSizeAndFormatAskedFor) {
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

TEST_F(Pictures, EqualWishesAreDrawnAndEncodedOnce) {
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

TEST_F(Pictures, EveryViewAndPresetDrawsAndWrongOnesAreErrors) {
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

TEST_F(Pictures, ABurstOfPosesIsAnsweredByTheNewest) {
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

}  // namespace
}  // namespace furrow::testing_net
