// SPDX-License-Identifier: Apache-2.0
// Poses over real sockets give the same weights as the solver.
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon_fixture.h"
#include "motion/clip_file.h"

namespace furrow::testing_net {
namespace {

std::int64_t Microseconds(double seconds) { return std::llround(seconds * 1e6); }

// Sends the clip pose by pose, each after receiving the weights of the previous one.
void PlayAndCompare(RawClient& sender, RawClient& viewer, const motion::Clip& clip,
                    const std::vector<std::vector<float>>& expected, double tolerance,
                    const protocol::PoseEncoding& encoding) {
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  Offer(sender, offer);
  const auto reply = Watch(viewer, {.subject = "ann"});
  ASSERT_TRUE(reply.has_value());
  double moved = 0.0;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    sender.Send(PoseOf(clip, frame, offer), 1, static_cast<std::uint32_t>(frame),
                Microseconds(clip.times[frame]), encoding);
    protocol::Header header;
    const auto weights = viewer.Await<protocol::WeightFrame>(&header);
    ASSERT_TRUE(weights.has_value()) << frame;
    ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame));
    ASSERT_EQ(header.capture_time_us, Microseconds(clip.times[frame]));
    ASSERT_EQ(weights->names_hash, reply->names_hash);
    ASSERT_EQ(weights->values.size(), expected[frame].size());
    for (std::size_t i = 0; i < expected[frame].size(); ++i) {
      ASSERT_NEAR(weights->values[i], expected[frame][i], tolerance) << reply->names[i];
      moved = std::max<double>(moved, expected[frame][i]);
    }
  }
  EXPECT_GT(moved, 0.3) << "the clip moves nothing: the comparison says nothing";
}

TEST(Weights, OverUdpEqualTheSolver) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(120);
  UdpClient sender(daemon.ready().udp);
  UdpClient viewer(daemon.ready().udp);
  ASSERT_TRUE(viewer.Prove());
  PlayAndCompare(sender, viewer, clip, Solve(clip, "arkit.json"), 1e-5, {});
}

TEST(Weights, QuantisedOverTcpAreWithinTheWiresError) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(120);
  TcpClient sender(daemon.ready().tcp);
  TcpClient viewer(daemon.ready().tcp);
  PlayAndCompare(sender, viewer, clip, Solve(clip, "arkit.json"), 1e-3,
                 protocol::PoseEncoding::Small());
}

TEST(Weights, OfBodyCaptureEqualTheSolver) {
  const auto path = std::filesystem::path(FURROW_SHARED_DATA) / "cmu" / "01_01.bvh";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  auto loaded = motion::LoadClip(path);
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  motion::Clip clip = *std::move(loaded);
  clip.times.resize(300);  // knees and elbows bend early in the clip
  DaemonThread daemon(WeightsConfig("cmu.json"));
  ASSERT_TRUE(daemon.serves());
  UdpClient sender(daemon.ready().udp);
  TcpClient viewer(daemon.ready().tcp);
  PlayAndCompare(sender, viewer, clip, Solve(clip, "cmu.json"), 1e-4, {});
}

TEST(Weights, ARestartedSenderRestartsTheSubject) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(30);
  const auto expected = Solve(clip, "arkit.json");
  for (std::uint64_t session = 1; session <= 3; ++session) {
    UdpClient sender(daemon.ready().udp);
    TcpClient viewer(daemon.ready().tcp);
    sender.session = session;
    PlayAndCompare(sender, viewer, clip, expected, 1e-5, {});
    sender.Send(protocol::Goodbye{}, 1);
  }
  EXPECT_EQ(daemon.Count(server::Counter::kSubjectsRestarted), 2u);
}

TEST(Weights, PartialPosesBuildOnEarlierPoses) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  motion::Clip clip = ArkitClip(40);
  for (int frame = 1; frame < 40; ++frame) {
    for (int shape = 0; shape < 52; shape += 2) {
      clip.blend_shapes[frame * 52 + shape] = clip.blend_shapes[(frame - 1) * 52 + shape];
    }
  }
  const auto expected = Solve(clip, "arkit.json");
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  TcpClient client(daemon.ready().tcp);
  Offer(client, offer);
  ASSERT_TRUE(Watch(client, {.subject = "ann"}).has_value());
  for (int frame = 0; frame < 40; ++frame) {
    protocol::PoseFrame pose = PoseOf(clip, frame, offer);
    if (frame > 0) {
      pose.partial = true;
      pose.blend_shape_indices.clear();
      pose.blend_shapes.clear();
      for (std::uint16_t shape = 1; shape < 52; shape += 2) {
        pose.blend_shape_indices.push_back(shape);
        pose.blend_shapes.push_back(clip.blend_shapes[frame * 52 + shape]);
      }
    }
    client.Send(pose, 1, static_cast<std::uint32_t>(frame), Microseconds(clip.times[frame]));
    const auto weights = client.Await<protocol::WeightFrame>();
    ASSERT_TRUE(weights.has_value());
    for (std::size_t i = 0; i < expected[frame].size(); ++i) {
      ASSERT_NEAR(weights->values[i], expected[frame][i], 1e-5) << frame;
    }
  }
}

TEST(Weights, LateAndRepeatedDatagramsChangeNothing) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(60);
  const auto expected = Solve(clip, "arkit.json");
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  UdpClient sender(daemon.ready().udp);
  TcpClient viewer(daemon.ready().tcp);
  Offer(sender, offer);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  std::mt19937 random(11);
  for (int frame = 0; frame < 60; ++frame) {
    const auto send = [&](int which) {
      sender.Send(PoseOf(clip, which, offer), 1, static_cast<std::uint32_t>(which),
                  Microseconds(clip.times[which]));
    };
    send(frame);
    send(frame);                                     // twice
    send(static_cast<int>(random() % (frame + 1)));  // late
    protocol::Header header;
    const auto weights = viewer.Await<protocol::WeightFrame>(&header);
    ASSERT_TRUE(weights.has_value());
    ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame));
    ASSERT_NEAR(weights->values[0], expected[frame][0], 1e-5);
  }
  sender.Send(protocol::Ping{1});
  ASSERT_TRUE(sender.Await<protocol::Pong>().has_value());  // all poses have been processed
  EXPECT_EQ(daemon.Count(server::Counter::kPosesReceived), 180u);
  EXPECT_EQ(
      daemon.Count(server::Counter::kPosesLate) + daemon.Count(server::Counter::kPosesDuplicate),
      120u);
}

TEST(Weights, TwoSubjectsTwoFormatsTwoPatterns) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(2);
  TcpClient sender(daemon.ready().tcp);
  Offer(sender, OfferOf(clip, "ann"), 1);
  Offer(sender, OfferOf(clip, "ben"), 2);
  TcpClient viewer(daemon.ready().tcp);
  const auto brows = Watch(
      viewer, {.subject = "ben", .pattern = "brow_?.*", .format = protocol::WeightFormat::kU8});
  ASSERT_TRUE(brows.has_value());
  for (const std::string& name : brows->names) EXPECT_EQ(name.substr(0, 5), "brow_");
  protocol::PoseFrame pose = PoseOf(clip, 0, OfferOf(clip, "ann"));
  pose.blend_shapes.assign(52, 1.0f);
  sender.Send(pose, 1, 0, 1000);
  sender.Send(PoseOf(clip, 1, OfferOf(clip, "ben")), 2, 77, 2000);
  protocol::Header header;
  const auto weights = viewer.Await<protocol::WeightFrame>(&header);
  ASSERT_TRUE(weights.has_value());
  EXPECT_EQ(header.sequence, 77u) << "ann's pose must not reach subscribers of ben";
  EXPECT_EQ(weights->format, protocol::WeightFormat::kU8);
  EXPECT_EQ(weights->values.size(), brows->names.size());
  for (const float value : weights->values) {
    EXPECT_NEAR(value * 255.0f, std::round(value * 255.0f), 1e-3);
  }
}

TEST(Weights, ARateLimitSkipsPoses) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(1);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  TcpClient sender(daemon.ready().tcp);
  TcpClient slow(daemon.ready().tcp);
  TcpClient fast(daemon.ready().tcp);
  Offer(sender, offer);
  ASSERT_TRUE(Watch(slow, {.subject = "ann", .max_rate_hz = 0.01f}).has_value());
  ASSERT_TRUE(Watch(fast, {.subject = "ann"}).has_value());
  for (std::uint32_t i = 0; i < 50; ++i) {
    sender.Send(PoseOf(clip, 0, offer), 1, i, i * 1000);
    protocol::Header header;
    ASSERT_TRUE(fast.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_EQ(header.sequence, i);
  }
  slow.Send(protocol::Ping{5});
  ASSERT_TRUE(slow.Await<protocol::Pong>().has_value());
  EXPECT_EQ(slow.skipped.size(), 1u) << "one frame in a hundred seconds";
  EXPECT_EQ(daemon.Count(server::Counter::kFramesSkippedRate), 49u);
}

}  // namespace
}  // namespace furrow::testing_net
