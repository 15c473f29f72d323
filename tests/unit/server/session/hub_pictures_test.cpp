// SPDX-License-Identifier: Apache-2.0
// Subscribing to pictures: what is drawn for whom, and what cannot be had.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;
using testing::ElementsAre;

class HubPictures : public HubPeersTest {};

TEST_F(HubPictures, EqualPicturesAreDrawnOnceAndFoundByTheirTickets) {
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
  hub->OnPicture(picture);
  EXPECT_TRUE(viewer.inbox.empty());
  const auto image = second.Take<protocol::ImageFrame>();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->header.stream, normal);
  EXPECT_EQ(image->header.capture_time_us, 777);
  EXPECT_THAT(image->message.bytes, ElementsAre(1, 2, 3));
  hub->RemovePeer(second.id);
  hub->OnPicture(picture);  // too late: nobody is there, nothing happens
}

TEST_F(HubPictures, APictureLargerThanTheWireCarriesIsCountedAndNotSent) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePictures{.subject = "ann"}, 0, 1);
  viewer.Take<protocol::SubscribeReply>();
  Send(sender, Pose(1), 1, 0);
  ASSERT_EQ(pictures.jobs.size(), 1u);
  FinishedPicture picture;
  picture.width = picture.height = 4096;
  picture.bytes.resize(protocol::kMaxReplyBytes);
  picture.tickets = pictures.jobs[0].tickets;
  hub->OnPicture(picture);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(Count(Counter::kPicturesFailed), 1u);
  EXPECT_EQ(Count(Counter::kPicturesSent), 0u);
}

TEST_F(HubPictures, NothingIsDrawnWhileNobodyWatches) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 0);
  EXPECT_TRUE(pictures.jobs.empty());
}

TEST_F(HubPictures, PicturesThatCannotBeHadAreErrors) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePictures{.view = "xray"});
  ExpectError(viewer, ErrorCode::kBadPicture);
  Send(viewer, protocol::SubscribePictures{.camera_preset = "moon"});
  ExpectError(viewer, ErrorCode::kBadPicture);
  protocol::SubscribePictures fisheye;
  fisheye.has_camera = true;
  fisheye.camera.vertical_fov_degrees = 165.0f;  // the wire carries it, the renderer does not
  Send(viewer, fisheye);
  ExpectError(viewer, ErrorCode::kBadPicture);
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  hub->OnBytesReceived(udp.id, 1000, now);
  Send(udp, protocol::SubscribePictures{});
  ExpectError(udp, ErrorCode::kNeedsTcp);
}

TEST_F(HubPictures, WithoutARendererPicturesAreRefused) {
  Hub::Parts parts;
  parts.rig = std::make_shared<const wrinkle::Rig>(MakeRig(false));
  parts.metrics = &metrics;
  parts.make_token = [] { return 1; };
  hub = std::make_unique<Hub>(std::move(parts));
  Connect(&viewer);
  Send(viewer, protocol::SubscribePictures{.wait = true});
  ExpectError(viewer, ErrorCode::kNotRendering);
}

}  // namespace
}  // namespace furrow::server
