// SPDX-License-Identifier: Apache-2.0
// Garbage, malformed streams, slow readers and ports in use do not affect other clients.
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "daemon_fixture.h"

namespace furrow::testing_net {
namespace {

using server::Counter;

TEST(Robustness, GarbageDatagramsLeaveARealStreamUnharmed) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(200);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  UdpClient sender(daemon.ready().udp);
  UdpClient hostile(daemon.ready().udp);
  UdpClient pacer(daemon.ready().udp);
  ASSERT_TRUE(pacer.Prove());
  hostile.session = 1;
  ASSERT_TRUE(hostile.Prove());
  TcpClient viewer(daemon.ready().tcp);
  Offer(sender, offer);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  std::mt19937 random(5);
  std::vector<std::uint8_t> good;
  protocol::Encoder().Encode({1, 1, 1, 1}, PoseOf(clip, 0, offer), good);
  for (int frame = 0; frame < 200; ++frame) {
    // 12,000 per second at 60 Hz: noise, truncated and damaged messages.
    for (int i = 0; i < 200; ++i) {
      std::vector<std::uint8_t> bytes(good.begin(), good.begin() + random() % good.size());
      if (i % 3 == 0) bytes.assign(random() % 1400, static_cast<std::uint8_t>(random()));
      if (i % 3 == 1) {
        bytes = good;
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
      }
      hostile.SendRaw(bytes);
      // On a slow machine, the socket buffer must not overflow; this test is not about that.
      if (i % 50 == 0) {
        pacer.Send(protocol::Ping{i});
        ASSERT_TRUE(pacer.Await<protocol::Pong>().has_value());
      }
    }
    sender.Send(PoseOf(clip, frame, offer), 1, static_cast<std::uint32_t>(frame), frame * 16'667);
    protocol::Header header;
    ASSERT_TRUE(viewer.Await<protocol::WeightFrame>(&header).has_value()) << frame;
    ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame));
  }
  EXPECT_GT(daemon.Count(Counter::kDatagramsMalformed), 1000u);
  EXPECT_EQ(daemon.Count(Counter::kPosesLate), 0u);
}

TEST(Robustness, AnInvalidFrameLengthClosesOnlyItsConnection) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  TcpClient other(daemon.ready().tcp);
  for (const std::uint32_t length : {0u, 31u, 512u * 1024u + 1u, 0xFFFFFFFFu}) {
    TcpClient bad(daemon.ready().tcp);
    bad.SendRaw(protocol::FramePrefix(length));
    bad.SendRaw(std::vector<std::uint8_t>(5000, 0xAB));
    const auto error = bad.Await<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value()) << length;
    EXPECT_EQ(error->code, protocol::ErrorCode::kMalformed);
    EXPECT_TRUE(bad.AwaitClose());
  }
  EXPECT_EQ(daemon.Count(Counter::kConnectionsMalformed), 4u);
  other.Send(protocol::Ping{9});
  EXPECT_EQ(other.Await<protocol::Pong>()->time_us, 9);
}

TEST(Robustness, AMalformedMessageDoesNotCloseTheConnection) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  TcpClient client(daemon.ready().tcp);
  const std::vector<std::uint8_t> noise(100, 0x11);
  client.SendRaw(protocol::FramePrefix(noise.size()));
  client.SendRaw(noise);
  EXPECT_EQ(client.Await<protocol::ErrorMessage>()->code, protocol::ErrorCode::kMalformed);
  client.Send(protocol::Ping{3});
  EXPECT_EQ(client.Await<protocol::Pong>()->time_us, 3);
}

TEST(Robustness, AMessageMayArriveByteByByte) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  TcpClient client(daemon.ready().tcp);
  std::vector<std::uint8_t> message;
  protocol::Encoder().Encode({1, 0, 0, 0}, protocol::Ping{77}, message);
  const auto prefix = protocol::FramePrefix(message.size());
  for (const std::uint8_t byte : prefix) client.SendRaw({&byte, 1});
  for (const std::uint8_t byte : message) client.SendRaw({&byte, 1});
  EXPECT_EQ(client.Await<protocol::Pong>()->time_us, 77);
}

TEST(Robustness, UnknownSubjectsAndPicturesWithoutARendererAreErrors) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  TcpClient client(daemon.ready().tcp);
  client.Send(protocol::SubscribeWeights{.subject = "nobody"}, 0, 5);
  protocol::Header header;
  const auto error = client.Await<protocol::ErrorMessage>(&header);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, protocol::ErrorCode::kUnknownSubject);
  EXPECT_EQ(header.sequence, 5u);
  client.Send(protocol::SubscribePictures{.wait = true}, 0, 6);
  EXPECT_EQ(client.Await<protocol::ErrorMessage>()->code, protocol::ErrorCode::kNotRendering);
}

TEST(Robustness, ASlowSubscriberLosesOldFramesAndDelaysNobody) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(1);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  TcpClient sender(daemon.ready().tcp);
  TcpClient slow(daemon.ready().tcp);
  TcpClient fast(daemon.ready().tcp);
  Offer(sender, offer);
  // Many subscriptions of a peer that does not read fill the socket buffers quickly.
  for (std::uint32_t i = 0; i < 60; ++i) {
    ASSERT_TRUE(Watch(slow, {.subject = "ann", .source = protocol::WeightSource::kDriverValues}, i)
                    .has_value());
  }
  ASSERT_TRUE(Watch(fast, {.subject = "ann"}).has_value());
  std::uint32_t sent = 0;
  while (daemon.Count(Counter::kWeightsDroppedSlow) < 1000 && sent < 20'000) {
    sender.Send(PoseOf(clip, 0, offer), 1, sent, sent * 1000);
    protocol::Header header;
    ASSERT_TRUE(fast.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_EQ(header.sequence, sent++);
  }
  EXPECT_GE(daemon.Count(Counter::kWeightsDroppedSlow), 1000u);
  // When it reads again, it receives frames in order up to the newest.
  std::int64_t newest = -1;
  while (newest + 1 < sent) {
    protocol::Header header;
    ASSERT_TRUE(slow.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_GE(static_cast<std::int64_t>(header.sequence), newest);
    newest = header.sequence;
  }
}

// Frames that may not be left out wait for clients that do not read, until their host has its
// share. Nobody else notices, and nobody is disconnected.
TEST(Robustness, WhatWaitsForSlowClientsIsBoundedAndDelaysNobody) {
  server::Config config = WeightsConfig("arkit.json");
  config.limits.max_waiting_megabytes = 72;
  config.limits.idle_seconds = 1e6;  // a slow machine must not count as idle
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(1);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  TcpClient sender(daemon.ready().tcp);
  TcpClient fast(daemon.ready().tcp);
  Offer(sender, offer);
  // At most 8 MiB wait for each, and 36 MB for their host.
  constexpr int kSlow = 6;
  std::vector<std::unique_ptr<TcpClient>> slow;
  for (int i = 0; i < kSlow; ++i) {
    TcpClient& client = *slow.emplace_back(std::make_unique<TcpClient>(daemon.ready().tcp));
    for (std::uint32_t number = 0; number < 60; ++number) {
      const protocol::SubscribeWeights request{
          .subject = "ann", .source = protocol::WeightSource::kDriverValues, .every = true};
      ASSERT_TRUE(Watch(client, request, number).has_value());
    }
  }
  ASSERT_TRUE(Watch(fast, {.subject = "ann"}).has_value());
  for (std::uint32_t sent = 0; daemon.Count(Counter::kWaitingRefused) < 10'000; ++sent) {
    ASSERT_LT(sent, 20'000u);
    sender.Send(PoseOf(clip, 0, offer), 1, sent, sent * 1000);
    protocol::Header header;
    ASSERT_TRUE(fast.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_EQ(header.sequence, sent);
  }
  // They read again, and learn that frames are missing.
  for (auto& client : slow) {
    const auto dropped = client->Await<protocol::Dropped>();
    ASSERT_TRUE(dropped.has_value());
    EXPECT_GT(dropped->frames, 0u);
    client->skipped.clear();
  }
  EXPECT_EQ(daemon.Count(Counter::kConnectionsOverrun), 0u);
}

TEST(Robustness, AnIdleConnectionIsClosed) {
  server::Config config = WeightsConfig("arkit.json");
  config.limits.idle_seconds = 0.01;
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  TcpClient silent(daemon.ready().tcp);
  EXPECT_TRUE(silent.AwaitClose());
  EXPECT_EQ(daemon.Count(Counter::kConnectionsIdle), 1u);
}

TEST(Robustness, AClientThatDoesNotReadRepliesIsClosed) {
  server::Config config = WeightsConfig("arkit.json");
  config.limits.packets_per_second = config.limits.packet_burst = 1e9;
  config.limits.idle_seconds = 1e6;  // a slow machine must not count as idle
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  TcpClient asker(daemon.ready().tcp);
  const int small = 4096;
  ::setsockopt(asker.socket(), SOL_SOCKET, SO_RCVBUF, &small, sizeof(small));
  std::vector<std::uint8_t> message;
  protocol::Encoder().Encode({1, 0, 0, 0}, protocol::Ping{77}, message);
  const auto prefix = protocol::FramePrefix(message.size());
  std::vector<std::uint8_t> many;
  for (int i = 0; i < 1000; ++i) {
    many.insert(many.end(), prefix.begin(), prefix.end());
    many.insert(many.end(), message.begin(), message.end());
  }
  while (daemon.Count(Counter::kConnectionsOverrun) == 0) asker.SendRaw(many);
  TcpClient other(daemon.ready().tcp);
  other.Send(protocol::Ping{9});
  EXPECT_EQ(other.Await<protocol::Pong>()->time_us, 9);
}

TEST(Robustness, AnExceptionIsAFailureAndNotACrash) {
  server::RunOptions options;
  options.on_ready = [](const server::Ready&) { throw std::runtime_error("no thread to be had"); };
  EXPECT_EQ(server::Run(WeightsConfig("arkit.json"), options), server::ExitCode::kFailed);
}

TEST(Robustness, ConnectionsBeyondTheLimitAreRefused) {
  server::Config config = WeightsConfig("arkit.json");
  config.limits.max_connections = 3;  // two for one host
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  TcpClient first(daemon.ready().tcp);
  TcpClient second(daemon.ready().tcp);
  for (TcpClient* client : {&first, &second}) {
    client->Send(protocol::Ping{1});
    ASSERT_TRUE(client->Await<protocol::Pong>().has_value());
  }
  TcpClient third(daemon.ready().tcp);
  const auto error = third.Await<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, protocol::ErrorCode::kLimit);
  EXPECT_TRUE(third.AwaitClose());
  EXPECT_EQ(daemon.Count(Counter::kConnectionsRefused), 1u);
}

TEST(Robustness, ASecondDaemonOnAPortFails) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  server::Config same_tcp = WeightsConfig("arkit.json");
  same_tcp.tcp = daemon.ready().tcp;
  server::Config same_udp = WeightsConfig("arkit.json");
  same_udp.udp = daemon.ready().udp;
  for (const server::Config& config : {same_tcp, same_udp}) {
    DaemonThread second(config);
    EXPECT_FALSE(second.serves());
    EXPECT_EQ(second.Stop(), server::ExitCode::kFailed);
  }
}

TEST(Robustness, AMissingRigIsBadInput) {
  DaemonThread daemon(WeightsConfig("nowhere.json"));
  EXPECT_FALSE(daemon.serves());
  EXPECT_EQ(daemon.Stop(), server::ExitCode::kBadInput);
}

TEST(Robustness, MissingSettingsAreBadInput) {
  server::Config config = WeightsConfig("arkit.json");
  config.render_settings = "nowhere.toml";
  DaemonThread daemon(config);
  EXPECT_FALSE(daemon.serves());
  EXPECT_EQ(daemon.Stop(), server::ExitCode::kBadInput);
}

// More than the socket buffers hold, so frames are queued in the daemon when draining begins.
TEST(Robustness, SubscriptionsToEveryFrameCompleteBeforeTheGoodbye) {
  constexpr int kFrames = 20'000;
  server::Config config = WeightsConfig("arkit.json");
  config.limits.packet_burst = 2 * kFrames;
  config.limits.drain_seconds = 60;  // only prevents hanging
  DaemonThread daemon(config);
  TcpClient publisher(daemon.ready().tcp);
  const motion::Clip clip = ArkitClip(50);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  Offer(publisher, offer);
  TcpClient viewer(daemon.ready().tcp);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann", .every = true}).has_value());
  for (int i = 0; i < kFrames; ++i) {
    publisher.Send(PoseOf(clip, i % 50, offer), 1, static_cast<std::uint32_t>(i), 1 + i * 10'000);
  }
  publisher.Send(protocol::Ping{1});
  ASSERT_TRUE(publisher.Await<protocol::Pong>().has_value());  // all poses have been processed
  ASSERT_EQ(daemon.Count(server::Counter::kWeightsDroppedSlow), 0u);

  std::jthread stop([&] { EXPECT_EQ(daemon.Stop(), server::ExitCode::kOk); });
  ASSERT_TRUE(publisher.Await<protocol::Goodbye>().has_value());
  int frames = 0;
  while (viewer.Await<protocol::WeightFrame>().has_value()) ++frames;
  EXPECT_EQ(frames, kFrames);
  EXPECT_EQ(viewer.skipped.size(), 1u);  // the goodbye
}

TEST(Robustness, DrainingSaysGoodbyeAndCloses) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  TcpClient client(daemon.ready().tcp);
  client.Send(protocol::Ping{1});
  ASSERT_TRUE(client.Await<protocol::Pong>().has_value());
  EXPECT_EQ(daemon.Stop(), server::ExitCode::kOk);
  const auto goodbye = client.Await<protocol::Goodbye>();
  ASSERT_TRUE(goodbye.has_value());
  EXPECT_EQ(goodbye->reason, protocol::GoodbyeReason::kDraining);
  EXPECT_TRUE(client.AwaitClose());
}

// All TCP places of this host are taken by subscriptions that wait for a subject which never comes.
TEST(Robustness, WaitingSubscriptionsGiveWayToANewcomer) {
  server::Config config = WeightsConfig("arkit.json");
  config.limits.max_connections = 64;  // 32 for one host
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  std::vector<std::unique_ptr<TcpClient>> waiting;
  for (int i = 0; i < 32; ++i) {
    waiting.push_back(std::make_unique<TcpClient>(daemon.ready().tcp));
    ASSERT_TRUE(Watch(*waiting.back(), {.subject = "nobody", .wait = true}).has_value()) << i;
  }
  const motion::Clip clip = ArkitClip(1);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  TcpClient sender(daemon.ready().tcp);
  Offer(sender, offer);
  TcpClient viewer(daemon.ready().tcp);
  ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
  sender.Send(PoseOf(clip, 0, offer), 1, 1);
  EXPECT_TRUE(viewer.Await<protocol::WeightFrame>().has_value());
  EXPECT_EQ(daemon.Count(Counter::kConnectionsRefused), 0u);
  EXPECT_EQ(daemon.Count(Counter::kConnectionsGaveWay), 2u);
  // The first two learn why they had to go.
  for (int i = 0; i < 2; ++i) {
    const auto error = waiting[i]->Await<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value()) << i;
    EXPECT_EQ(error->code, protocol::ErrorCode::kLimit);
    EXPECT_TRUE(waiting[i]->AwaitClose());
  }
  waiting[2]->Send(protocol::Ping{7});
  EXPECT_TRUE(waiting[2]->Await<protocol::Pong>().has_value()) << "the others stay";
}

}  // namespace
}  // namespace furrow::testing_net
