// SPDX-License-Identifier: Apache-2.0
// Picture subscriptions: flow control, changing views, shared pictures, errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;
using testing::ElementsAre;

class PictureViewsFlowTest : public HubPeersTest {
 protected:
  std::uint16_t View(FakePeer& peer, std::uint32_t request = 1) {
    Send(peer, protocol::SubscribePictures{.subject = "ann", .acknowledged = true}, 0, request);
    const auto reply = peer.Take<protocol::SubscribeReply>();
    return reply ? reply->header.stream : 0;
  }
  void Pose1(float brow) {
    const std::uint32_t number = sequence++;
    Send(sender, Pose(brow), 1, number, 1'000'000 + number * 16'667);
  }
  // Finishes every waiting job and delivers its pictures.
  void DrawAll() {
    const std::vector<RenderJob> jobs = std::move(pictures.jobs);
    pictures.jobs.clear();
    for (const RenderJob& job : jobs) {
      if (job.tickets.empty()) continue;
      hub->OnPicture({.sequence = job.snapshot->sequence,
                      .received_us = job.snapshot->received_us,
                      .width = job.spec.width,
                      .height = job.spec.height,
                      .encoding = job.tickets.front().encoding,
                      .bytes = {1, 2, 3},
                      .tickets = job.tickets},
                     now);
    }
  }
  std::size_t Tickets() const {
    std::size_t count = 0;
    for (const RenderJob& job : pictures.jobs) count += job.tickets.size();
    return count;
  }
  std::uint32_t sequence = 0;
};

TEST_F(PictureViewsFlowTest, AStalledViewerContinuesWithTheNewestPose) {
  Publish(sender, "ann");
  const std::uint16_t stream = View(viewer);
  for (int i = 0; i < 2; ++i) {
    Pose1(0.1f * static_cast<float>(i));
    ASSERT_EQ(Tickets(), 1u);
    DrawAll();
    Advance(0.016);
  }
  for (int i = 0; i < 50; ++i) {
    Pose1(0.5f + 0.01f * static_cast<float>(i % 7));
    Advance(0.016);
    hub->Tick(now);
  }
  EXPECT_EQ(Tickets(), 0u);
  EXPECT_EQ(viewer.Take<protocol::ImageFrame>()->message.number, 1u);
  EXPECT_EQ(viewer.Take<protocol::ImageFrame>()->message.number, 2u);
  EXPECT_TRUE(viewer.inbox.empty());
  Send(viewer, protocol::FrameAck{2}, stream);
  ASSERT_EQ(Tickets(), 1u);
  EXPECT_EQ(pictures.jobs.back().snapshot->sequence, sequence - 1);
  DrawAll();
  const auto fresh = viewer.Take<protocol::ImageFrame>();
  ASSERT_TRUE(fresh.has_value());
  EXPECT_EQ(fresh->message.number, 3u);
  EXPECT_EQ(fresh->message.dropped, 50u);
  EXPECT_EQ(fresh->header.sequence, sequence - 1);
}

TEST_F(PictureViewsFlowTest, AWaitingPictureShowsTheNewestPose) {
  Publish(sender, "ann");
  View(viewer);
  Pose1(0.1f);
  Advance(0.016);
  Pose1(0.9f);
  ASSERT_EQ(pictures.jobs.size(), 2u);
  EXPECT_EQ(pictures.jobs[0].tickets.size(), 1u);
  EXPECT_TRUE(pictures.jobs[1].tickets.empty());  // only refreshes the first job
  EXPECT_EQ(pictures.jobs[1].snapshot->sequence, 1u);
}

TEST_F(PictureViewsFlowTest, ViewersOfOneViewAndTierShareAnEncoding) {
  Publish(sender, "ann");
  std::vector<FakePeer> viewers(16);
  for (FakePeer& peer : viewers) {
    Connect(&peer, Transport::kWeb);
    ASSERT_NE(View(peer), 0);
  }
  Pose1(0.5f);
  ASSERT_EQ(pictures.jobs.size(), 1u);
  ASSERT_EQ(pictures.jobs[0].tickets.size(), 16u);
  for (const PictureTicket& ticket : pictures.jobs[0].tickets) {
    EXPECT_EQ(ticket.encoding, pictures.jobs[0].tickets[0].encoding);
    EXPECT_TRUE(ticket.acknowledges);
  }
}

TEST_F(PictureViewsFlowTest, APoseAtRestGetsOneStill) {
  Publish(sender, "ann");
  const std::uint16_t stream = View(viewer);
  std::uint32_t stills = 0;
  std::uint32_t pictures_sent = 0;
  double still_after = 0.0;
  Pose1(0.5f);
  const Time rest = now;
  for (int i = 0; i < 60; ++i) {
    if (i > 0) Pose1(0.5f);  // the stream continues while the performer rests
    hub->Tick(now);
    for (const RenderJob& job : pictures.jobs) {
      for (const PictureTicket& ticket : job.tickets) {
        if (!ticket.still) continue;
        EXPECT_GE(EncodingOf(ticket).quality, 90);
        still_after = ToSeconds(now - rest);
      }
    }
    DrawAll();
    while (const auto image = viewer.Take<protocol::ImageFrame>()) {
      ++pictures_sent;
      stills += image->message.still ? 1 : 0;
      Send(viewer, protocol::FrameAck{image->message.number}, stream);
    }
    Advance(0.01);
  }
  EXPECT_EQ(stills, 1u);
  EXPECT_LE(still_after, 0.15);
  EXPECT_LE(pictures_sent, 12u);  // 0.1 s of movement, and the still
  Pose1(0.7f);
  EXPECT_EQ(Tickets(), 1u);
  EXPECT_FALSE(pictures.jobs.front().tickets.front().still);
}

TEST_F(PictureViewsFlowTest, AnUpdateChangesTheViewAndAnInvalidOneDoesNot) {
  Publish(sender, "ann");
  const std::uint16_t stream = View(viewer);
  Pose1(0.5f);
  DrawAll();
  Send(viewer, protocol::FrameAck{1}, stream);
  viewer.inbox.clear();
  protocol::UpdatePictures update;
  update.pictures.width = 320;
  update.pictures.settings = {"wrinkles=off"};
  Send(viewer, update, stream, 21);
  ASSERT_EQ(Tickets(), 1u);
  EXPECT_EQ(pictures.jobs.back().spec.width, 320);
  EXPECT_FALSE(pictures.jobs.back().spec.settings->wrinkles);
  DrawAll();
  EXPECT_EQ(viewer.Take<protocol::ImageFrame>()->message.view_request, 21u);
  update.pictures.settings = {"subsurface.width=99"};
  Send(viewer, update, stream, 22);
  const auto error = viewer.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, ErrorCode::kBadPicture);
  EXPECT_EQ(error->header.sequence, 22u);
  EXPECT_NE(error->message.message.find("subsurface.width"), std::string::npos);
  Send(viewer, update, 99, 23);
  ExpectError(viewer, ErrorCode::kBadPicture);
}

TEST_F(PictureViewsFlowTest, ANewViewDoesNotWaitForTheOldStill) {
  Publish(sender, "ann");
  const std::uint16_t stream = View(viewer);
  Pose1(0.5f);
  DrawAll();
  Send(viewer, protocol::FrameAck{1}, stream);
  Advance(0.2);
  hub->Tick(now);
  ASSERT_EQ(Tickets(), 1u);
  ASSERT_TRUE(pictures.jobs.back().IsStill());
  pictures.withdraws = true;  // the still waits for the renderer
  protocol::UpdatePictures update;
  update.pictures.width = 320;
  Send(viewer, update, stream, 21);
  EXPECT_EQ(pictures.withdrawn.size(), 1u);
  ASSERT_EQ(pictures.jobs.back().spec.width, 320);
  EXPECT_FALSE(pictures.jobs.back().IsStill());
  EXPECT_EQ(pictures.jobs.back().tickets.size(), 1u);
  pictures.jobs.erase(pictures.jobs.begin());
  DrawAll();
  Advance(0.2);
  hub->Tick(now);
  ASSERT_EQ(Tickets(), 1u);
  EXPECT_TRUE(pictures.jobs.back().IsStill());  // of the new view
}

TEST_F(PictureViewsFlowTest, TheDaemonsSettingsReachViewsWithoutOverrides) {
  Publish(sender, "ann");
  FakePeer second;
  Connect(&second);
  View(viewer);
  Send(second,
       protocol::SubscribePictures{
           .subject = "ann", .acknowledged = true, .settings = {"exposure=2"}},
       0, 1);
  Pose1(0.5f);
  DrawAll();
  render::Settings settings;
  settings.exposure = 0.5f;
  hub->SetOwnSettings(settings, now);
  Advance(0.016);
  Pose1(0.6f);
  float least = 9.0f;
  float most = 0.0f;
  for (const RenderJob& job : pictures.jobs) {
    least = std::min(least, job.spec.settings->exposure);
    most = std::max(most, job.spec.settings->exposure);
  }
  EXPECT_EQ(least, 0.5f);
  EXPECT_EQ(most, 2.0f);
}

TEST_F(PictureViewsFlowTest, AFailedPictureIsRequestedAgain) {
  Publish(sender, "ann");
  View(viewer);
  Pose1(0.5f);
  ASSERT_EQ(Tickets(), 1u);
  hub->OnPicture({.tickets = pictures.jobs[0].tickets}, now);
  pictures.jobs.clear();
  hub->Tick(now);
  EXPECT_EQ(Tickets(), 0u);
  Advance(0.3);
  hub->Tick(now);
  EXPECT_EQ(Tickets(), 1u);
}

// Its host has no room for what waits. The viewer never learns of these pictures, and must not wait
// for ever for the next one.
TEST_F(PictureViewsFlowTest, APictureWithoutRoomIsRequestedAgain) {
  Publish(sender, "ann");
  const std::uint16_t stream = View(viewer);
  viewer.has_room = false;
  Pose1(0.5f);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(Tickets(), 1u) << i;
    DrawAll();
    Advance(0.3);
    hub->Tick(now);
  }
  EXPECT_EQ(Count(Counter::kPicturesDroppedSlow), 5u);
  viewer.has_room = true;
  DrawAll();
  const auto image = viewer.Take<protocol::ImageFrame>();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->message.number, 1u);
  Send(viewer, protocol::FrameAck{1}, stream);
  EXPECT_TRUE(viewer.inbox.empty()) << "a valid acknowledgement";
}

TEST_F(PictureViewsFlowTest, AcknowledgingAnUnsentPictureIsAnError) {
  Publish(sender, "ann");
  const std::uint16_t stream = View(viewer);
  Send(viewer, protocol::FrameAck{7}, stream);
  ExpectError(viewer, ErrorCode::kMalformed);
}

TEST_F(PictureViewsFlowTest, ANeutralAndANewRigChangeTheLiveWeights) {
  Publish(sender, "ann");
  Pose1(0.5f);
  Subject& subject = *hub->RequireAllDrivers("ann");
  EXPECT_NEAR(subject.pipeline->wrinkle_weights()[0], 0.5f, 1e-6f);
  hub->SetNeutral(subject, subject.pipeline->pose(), now);
  EXPECT_NEAR(subject.pipeline->wrinkle_weights()[0], 0.0f, 1e-6f);
  Pose1(0.75f);
  EXPECT_NEAR(subject.pipeline->wrinkle_weights()[0], 0.25f, 1e-6f);
  wrinkle::Rig doubled = hub->rig();
  doubled.drivers[0].blend_shape.full = 0.5f;
  ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(std::move(doubled)), now).ok());
  EXPECT_NEAR(subject.pipeline->wrinkle_weights()[0], 0.5f, 1e-6f);
  hub->SetNeutral(subject, std::nullopt, now);
  EXPECT_NEAR(subject.pipeline->wrinkle_weights()[0], 1.0f, 1e-6f);
}

// Viewers that list H.264.
class PictureViewsVideoTest : public PictureViewsFlowTest {
 protected:
  static protocol::SubscribePictures Wish() {
    return {.subject = "ann",
            .width = 321,
            .height = 200,
            .quality = 70,
            .acknowledged = true,
            .codecs = {"vp9", "h264"}};
  }
  std::uint16_t ViewVideo(const protocol::SubscribePictures& wish = Wish()) {
    Send(viewer, wish, 0, 1);
    const auto reply = viewer.Take<protocol::SubscribeReply>();
    return reply ? reply->header.stream : 0;
  }
  // Draws the waiting picture as the render thread does, and returns what the viewer receives.
  protocol::ImageFrame Draw(bool key, std::size_t bytes = 4) {
    EXPECT_EQ(Tickets(), 1u);
    const RenderJob job = pictures.jobs.back();
    pictures.jobs.clear();
    const PictureTicket& ticket = job.tickets.front();
    const bool is_video = ticket.video.has_value() && !ticket.still;
    hub->OnPicture({.sequence = job.snapshot->sequence,
                    .width = job.spec.width,
                    .height = job.spec.height,
                    .encoding = ticket.encoding,
                    .bytes = std::vector<std::uint8_t>(bytes, 1),
                    .codec = is_video ? "avc1.42c01e" : "",
                    .key = is_video && key,
                    .tickets = job.tickets},
                   now);
    const auto image = viewer.Take<protocol::ImageFrame>();
    return image ? image->message : protocol::ImageFrame();
  }
  std::optional<render::VideoTarget> Target() const {
    return pictures.jobs.back().tickets.front().video;
  }
  void NextPose() {
    Advance(0.033);
    Pose1(0.01f * static_cast<float>(sequence));
  }
};

TEST_F(PictureViewsVideoTest, MovingPicturesAreVideoAndStillsAreFiles) {
  Publish(sender, "ann");
  const std::uint16_t stream = ViewVideo();
  NextPose();
  ASSERT_EQ(pictures.opened.size(), 1u);
  EXPECT_EQ(pictures.opened[0].host, "") << "of the peers of this test";
  EXPECT_EQ(pictures.opened[0].format, (render::VideoFormat{322, 200, 70})) << "even";
  ASSERT_TRUE(Target().has_value());
  EXPECT_FALSE(Target()->key);
  EXPECT_EQ(pictures.jobs.back().spec.width, 321);
  const auto first = Draw(true);
  EXPECT_EQ(first.codec, "avc1.42c01e");
  EXPECT_TRUE(first.key);
  EXPECT_EQ(first.tier, 0);
  Send(viewer, protocol::FrameAck{1}, stream);
  Advance(0.2);
  hub->Tick(now);
  ASSERT_EQ(Tickets(), 1u);
  EXPECT_TRUE(pictures.jobs.back().tickets.front().still);
  EXPECT_TRUE(Target().has_value()) << "in case that it moves before it is drawn";
  const auto still = Draw(false);
  EXPECT_EQ(still.codec, "");
  EXPECT_TRUE(still.still);
  Send(viewer, protocol::FrameAck{2}, stream);
  NextPose();
  ASSERT_TRUE(Target().has_value());
  EXPECT_FALSE(Target()->key) << "a file changes nothing for the decoder";
}

TEST_F(PictureViewsVideoTest, OnlyViewersThatAskAndAcknowledgeGetVideo) {
  Publish(sender, "ann");
  const auto ticket_of = [&](const auto& change) {
    protocol::SubscribePictures wish = Wish();
    change(wish);
    const std::uint16_t stream = ViewVideo(wish);
    NextPose();
    const bool has_video = Target().has_value();
    pictures.jobs.clear();
    Send(viewer, protocol::Unsubscribe{}, stream);
    return has_video;
  };
  EXPECT_TRUE(ticket_of([](auto&) {}));
  EXPECT_FALSE(ticket_of([](auto& wish) { wish.acknowledged = false; }));
  EXPECT_FALSE(ticket_of([](auto& wish) { wish.codecs = {"vp9"}; }));
  EXPECT_FALSE(ticket_of([](auto& wish) { wish.format = protocol::ImageFormat::kPng; }));
  pictures.has_video = false;
  EXPECT_FALSE(ticket_of([](auto&) {})) << "there is no encoder to spare";
}

TEST_F(PictureViewsVideoTest, AnEncoderThatIsFreeLaterIsUsed) {
  Publish(sender, "ann");
  const std::uint16_t stream = ViewVideo();
  pictures.has_video = false;
  NextPose();
  EXPECT_FALSE(Target().has_value());
  EXPECT_EQ(Draw(false).codec, "");
  Send(viewer, protocol::FrameAck{1}, stream);
  pictures.has_video = true;
  NextPose();
  EXPECT_TRUE(Target().has_value());
}

TEST_F(PictureViewsVideoTest, AViewerMayAskForAKey) {
  Publish(sender, "ann");
  const std::uint16_t stream = ViewVideo();
  NextPose();
  Draw(true);
  Send(viewer, protocol::FrameAck{.number = 1, .needs_key = true}, stream);
  NextPose();
  ASSERT_TRUE(Target().has_value());
  EXPECT_TRUE(Target()->key);
  Draw(true);
  Send(viewer, protocol::FrameAck{2}, stream);
  NextPose();
  EXPECT_FALSE(Target()->key);
}

TEST_F(PictureViewsVideoTest, AFailedPictureIsFollowedByAKey) {
  Publish(sender, "ann");
  const std::uint16_t stream = ViewVideo();
  NextPose();
  Draw(true);
  Send(viewer, protocol::FrameAck{1}, stream);
  NextPose();
  Draw(false, protocol::kMaxReplyBytes);  // too large to be sent
  Advance(0.3);
  NextPose();
  EXPECT_TRUE(Target()->key);
}

TEST_F(PictureViewsVideoTest, AnUpdateEndsAndBeginsTheVideo) {
  Publish(sender, "ann");
  const std::uint16_t stream = ViewVideo();
  NextPose();
  Draw(true);
  Send(viewer, protocol::FrameAck{1}, stream);
  const std::uint64_t subscription = pictures.opened.front().subscription;
  protocol::UpdatePictures update{Wish()};
  update.pictures.codecs.clear();
  Send(viewer, update, stream, 2);
  EXPECT_EQ(pictures.closed, std::vector<std::uint64_t>{subscription});
  ASSERT_EQ(Tickets(), 1u);
  EXPECT_FALSE(Target().has_value());
  Draw(false);
  Send(viewer, protocol::FrameAck{2}, stream);
  Send(viewer, protocol::UpdatePictures{Wish()}, stream, 3);
  ASSERT_EQ(Tickets(), 1u);
  EXPECT_TRUE(Target().has_value());
}

TEST_F(PictureViewsVideoTest, ASlowLinkGetsFewerBits) {
  Publish(sender, "ann");
  const std::uint16_t stream = ViewVideo();
  std::vector<int> bits;
  double free_s = 0.0;
  double time_s = 0.0;
  for (std::uint32_t number = 1; number <= 60; ++number) {
    NextPose();
    time_s += 0.033;
    ASSERT_EQ(Tickets(), 1u);
    bits.push_back(Target()->bits);
    const std::size_t bytes = static_cast<std::size_t>(bits.back()) / 8;
    Draw(number == 1, bytes);
    // 400 kbit/s.
    free_s = std::max(free_s, time_s) + static_cast<double>(bytes) * 8.0 / 400e3;
    Advance(std::max(0.0, free_s - time_s));
    time_s = std::max(time_s, free_s);
    Send(viewer, protocol::FrameAck{number}, stream);
    pictures.jobs.clear();
  }
  EXPECT_LT(bits.back(), bits.front() / 2);
}

class PictureViewsTest : public HubPeersTest {};

TEST_F(PictureViewsTest, EqualPicturesAreRenderedOnce) {
  Publish(sender, "ann");
  FakePeer second;
  Connect(&second);
  protocol::SubscribePictures request{.subject = "ann", .width = 320, .height = 200};
  Send(viewer, request, 0, 1);
  Send(second, request, 0, 1);
  request.view = "normal";
  Send(second, request, 0, 2);
  ASSERT_EQ(viewer.Take<protocol::SubscribeReply>()->message.names_hash, 0u);
  second.Take<protocol::SubscribeReply>();
  const std::uint16_t normal = second.Take<protocol::SubscribeReply>()->header.stream;
  Send(sender, Pose(1), 1, 42, 777);
  ASSERT_EQ(pictures.jobs.size(), 2u);
  EXPECT_EQ(pictures.jobs[0].tickets.size() + pictures.jobs[1].tickets.size(), 3u);
  const RenderJob& job = pictures.jobs[0].tickets.size() == 1 ? pictures.jobs[0] : pictures.jobs[1];
  EXPECT_EQ(job.spec.view, render::View::kNormal);
  EXPECT_EQ(job.spec.width, 320);
  EXPECT_EQ(job.snapshot->sequence, 42u);

  FinishedPicture picture;
  picture.sequence = 42;
  picture.capture_time_us = 777;
  picture.width = 320;
  picture.height = 200;
  picture.bytes = {1, 2, 3};
  picture.tickets = job.tickets;
  hub->OnPicture(picture, now);
  EXPECT_TRUE(viewer.inbox.empty());
  const auto image = second.Take<protocol::ImageFrame>();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->header.stream, normal);
  EXPECT_EQ(image->header.capture_time_us, 777);
  EXPECT_THAT(image->message.bytes, ElementsAre(1, 2, 3));
  hub->RemovePeer(second.id);
  hub->OnPicture(picture, now);  // after the viewer has left, nothing happens
}

TEST_F(PictureViewsTest, AnOversizedPictureIsCountedAndNotSent) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePictures{.subject = "ann"}, 0, 1);
  viewer.Take<protocol::SubscribeReply>();
  Send(sender, Pose(1), 1, 0);
  ASSERT_EQ(pictures.jobs.size(), 1u);
  FinishedPicture picture;
  picture.width = picture.height = 4096;
  picture.bytes.resize(protocol::kMaxReplyBytes);
  picture.tickets = pictures.jobs[0].tickets;
  hub->OnPicture(picture, now);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(Count(Counter::kPicturesFailed), 1u);
  EXPECT_EQ(Count(Counter::kPicturesSent), 0u);
}

TEST_F(PictureViewsTest, NothingIsRenderedWithoutViewers) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 0);
  EXPECT_TRUE(pictures.jobs.empty());
}

TEST_F(PictureViewsTest, InvalidPictureRequestsAreErrors) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePictures{.view = "xray"});
  ExpectError(viewer, ErrorCode::kBadPicture);
  Send(viewer, protocol::SubscribePictures{.camera_preset = "moon"});
  ExpectError(viewer, ErrorCode::kBadPicture);
  protocol::SubscribePictures fisheye;
  fisheye.has_camera = true;
  fisheye.camera.vertical_fov_degrees = 165.0f;  // valid on the wire, not for the renderer
  Send(viewer, fisheye);
  ExpectError(viewer, ErrorCode::kBadPicture);
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  Send(udp, protocol::SubscribePictures{});
  ExpectError(udp, ErrorCode::kNeedsTcp);
}

TEST_F(PictureViewsTest, HugePicturesAreRefused) {
  Send(viewer, protocol::SubscribePictures{.wait = true, .width = 4096, .height = 1024}, 0, 1);
  EXPECT_TRUE(viewer.Take<protocol::SubscribeReply>().has_value());
  Send(viewer, protocol::SubscribePictures{.wait = true, .width = 4096, .height = 1025}, 0, 2);
  const auto error = viewer.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, ErrorCode::kBadPicture);
  EXPECT_NE(error->message.message.find("4096x1025"), std::string::npos);
}

TEST_F(PictureViewsTest, PicturesThatNeedTooMuchMemoryAreRefused) {
  Publish(sender, "ann");
  protocol::SubscribePictures request{.subject = "ann", .width = 2048, .height = 2048};
  request.settings = {"anti_aliasing.samples=8"};
  Send(viewer, request, 0, 1);
  const auto error = viewer.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, ErrorCode::kBadPicture);
  EXPECT_NE(error->message.message.find("MiB of textures; the limit is 512 MiB"), std::string::npos)
      << error->message.message;
  request.width = request.height = 640;
  Send(viewer, request, 0, 2);
  EXPECT_TRUE(viewer.Take<protocol::SubscribeReply>().has_value());
}

TEST_F(PictureViewsTest, TheJobsOfAViewerThatLeavesAreWithdrawn) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePictures{.subject = "ann"}, 0, 1);
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  Send(sender, Pose(0.5f), 1, 0);
  ASSERT_EQ(pictures.jobs.size(), 1u);
  const PictureTicket& ticket = pictures.jobs.front().tickets.front();
  EXPECT_EQ(ticket.viewer, viewer.id);
  EXPECT_FALSE(ticket.acknowledges) << "no flow control";
  Send(viewer, protocol::Unsubscribe{}, reply->header.stream);
  EXPECT_EQ(pictures.ended, std::vector<std::uint64_t>{ticket.subscription});
  Send(viewer, protocol::SubscribeWeights{.subject = "ann"}, 0, 2);
  hub->RemovePeer(viewer.id);
  EXPECT_EQ(pictures.ended.size(), 1u) << "weights have no jobs";
}

TEST_F(PictureViewsTest, WhileTheRendererDoesNotRespondPicturesAreRefused) {
  Publish(sender, "ann");
  pictures.stuck = true;
  Send(viewer, protocol::SubscribePictures{.subject = "ann"}, 0, 1);
  ExpectError(viewer, ErrorCode::kNotRendering);
  EXPECT_NE(Watch(viewer, {.subject = "ann"}, 2), 0) << "weights go on";
}

// What a client learns without subscribing is what its subscription would be told.
TEST_F(PictureViewsTest, TheReasonAgainstPicturesIsKnownWithoutASubscription) {
  Publish(sender, "ann");
  const auto code = [this](const protocol::SubscribePictures& request,
                           const Access& access = Access::Everything()) {
    const Hub::ExclusiveLock lock(*hub, 0);
    const auto why = hub->WhyNoPictures(request, access);
    return why ? std::optional(why->code) : std::nullopt;
  };
  EXPECT_EQ(code({.subject = "ann"}), std::nullopt);
  EXPECT_EQ(code({}), std::nullopt) << "the oldest subject";
  EXPECT_EQ(code({.subject = "bob"}), ErrorCode::kUnknownSubject);
  EXPECT_EQ(code({.subject = "bob", .wait = true}), std::nullopt);
  EXPECT_EQ(code({.subject = "ann", .view = "nonsense"}), ErrorCode::kBadPicture);
  EXPECT_EQ(code({.subject = "ann"}, Access()), ErrorCode::kNotPermitted);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
  pictures.stuck = true;
  EXPECT_EQ(code({.subject = "ann"}), ErrorCode::kNotRendering);
  hub->Drain(now);
  EXPECT_EQ(code({.subject = "ann"}), ErrorCode::kDraining);
}

TEST_F(PictureViewsTest, WithoutARendererPicturesAreRefused) {
  Hub::Parts parts;
  parts.rig = std::make_shared<const wrinkle::Rig>(MakeRig(false));
  parts.metrics = &metrics;
  parts.random = [] { return 1; };
  hub = std::make_unique<Hub>(std::move(parts));
  Connect(&viewer);
  Send(viewer, protocol::SubscribePictures{.wait = true});
  ExpectError(viewer, ErrorCode::kNotRendering);
}

}  // namespace
}  // namespace furrow::server
