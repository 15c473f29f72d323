// SPDX-License-Identifier: Apache-2.0
// Many subjects and many subscribers of a daemon over UDP.
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon_fixture.h"

namespace furrow::testing_net {
namespace {

constexpr int kPerformers = 16;
constexpr int kSubscribers = 64;
constexpr int kPosesEach = 20;
constexpr int kShapes = 52;

// The clip starting at a later frame.
motion::Clip From(const motion::Clip& clip, int frame) {
  motion::Clip rest = clip;
  rest.times.assign(clip.times.begin() + frame, clip.times.end());
  rest.blend_shapes.assign(clip.blend_shapes.begin() + frame * kShapes, clip.blend_shapes.end());
  return rest;
}

struct Performer {
  motion::Clip clip;
  protocol::SkeletonOffer offer;
  std::vector<std::vector<float>> expected;
};

std::vector<Performer> MakePerformers(UdpClient& sender) {
  std::vector<Performer> performers;
  const motion::Clip clip = ArkitClip(kPosesEach + kPerformers);
  for (int i = 0; i < kPerformers; ++i) {
    Performer& performer = performers.emplace_back();
    performer.clip = From(clip, i);
    performer.offer = OfferOf(performer.clip, "subject " + std::to_string(i));
    performer.expected = Solve(performer.clip, "arkit.json");
    Offer(sender, performer.offer, static_cast<std::uint16_t>(i + 1));
  }
  return performers;
}

// Receives the weights of one frame of every subject once, in any order.
void ExpectFrame(UdpClient& watcher, const std::vector<Performer>& performers, int frame) {
  std::vector<bool> seen(kPerformers);
  for (int i = 0; i < kPerformers; ++i) {
    protocol::Header header;
    const auto weights = watcher.Await<protocol::WeightFrame>(&header);
    ASSERT_TRUE(weights.has_value());
    ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame));
    const auto subject = static_cast<std::size_t>(header.stream - 1);
    ASSERT_LT(subject, performers.size());
    ASSERT_FALSE(seen[subject]);
    seen[subject] = true;
    const auto& expected = performers[subject].expected[static_cast<std::size_t>(frame)];
    ASSERT_EQ(weights->values.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_NEAR(weights->values[k], expected[k], 1e-5) << frame << " " << k;
  }
}

TEST(FanOut, WeightsArriveAtEverySubscriberInFewerDatagrams) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  UdpClient sender(daemon.ready().udp);
  const std::vector<Performer> performers = MakePerformers(sender);
  std::deque<UdpClient> watchers;
  for (int i = 0; i < kSubscribers; ++i) {
    UdpClient& watcher = watchers.emplace_back(daemon.ready().udp);
    ASSERT_TRUE(watcher.Prove(/*bundles=*/i > 0));  // the first is an old client without bundles
    for (std::uint32_t k = 0; k < kPerformers; ++k) {
      const auto reply = Watch(watcher, {.subject = performers[k].offer.subject}, k + 1);
      ASSERT_TRUE(reply.has_value());
    }
  }
  const std::uint64_t before = watchers[0].datagrams();
  for (int frame = 0; frame < kPosesEach; ++frame) {
    const auto index = static_cast<std::size_t>(frame);
    for (std::size_t i = 0; i < performers.size(); ++i) {
      const double time = performers[i].clip.times[index];
      sender.Send(PoseOf(performers[i].clip, frame, performers[i].offer),
                  static_cast<std::uint16_t>(i + 1), static_cast<std::uint32_t>(frame),
                  std::llround(time * 1e6));
    }
    for (UdpClient& watcher : watchers) {
      ExpectFrame(watcher, performers, frame);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_EQ(daemon.Count(server::Counter::kWeightsSent),
            std::uint64_t{kSubscribers * kPerformers * kPosesEach});
  EXPECT_GE(watchers[0].datagrams() - before, std::uint64_t{kPerformers * kPosesEach});
  EXPECT_LE(watchers[0].datagrams() - before, kPerformers * kPosesEach + watchers[0].challenges());
  // While the first pose goes to 64 subscribers, the others arrive, so some messages share
  // datagrams.
  EXPECT_GT(daemon.Count(server::Counter::kMessagesBundled), 0u);
  EXPECT_LT(daemon.Count(server::Counter::kDatagramsSent),
            daemon.Count(server::Counter::kWeightsSent));
}

}  // namespace
}  // namespace furrow::testing_net
