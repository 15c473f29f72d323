// SPDX-License-Identifier: Apache-2.0
// A daemon with several network threads sends the same as one with a single thread, whichever
// thread serves a client.
#include <cmath>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon_fixture.h"
#include "recording/take_summary.h"
#include "tests/temporary_folder.h"

namespace furrow::testing_net {
namespace {

constexpr int kFrames = 12;
constexpr int kSubjects = 16;
constexpr int kWatchers = 8;

server::Config Threaded(int threads) {
  server::Config config = WeightsConfig("arkit.json");
  config.threads = threads;
  return config;
}

// Many publishers, each with a subject and a socket, so that every thread serves some.
class Troupe {
 public:
  explicit Troupe(const server::Ready& ready) {
    for (int i = 0; i < kSubjects; ++i) {
      offers_.push_back(OfferOf(clip_, "subject " + std::to_string(i)));
      std::unique_ptr<RawClient>& sender = senders_.emplace_back();
      if (i % 4 == 3) {
        sender = std::make_unique<TcpClient>(ready.tcp);
      } else {
        sender = std::make_unique<UdpClient>(ready.udp);
      }
      sender->session += static_cast<std::uint64_t>(i);
      Offer(*sender, offers_.back());
    }
  }
  void Send(int frame) {
    for (std::size_t i = 0; i < senders_.size(); ++i) {
      senders_[i]->Send(PoseOf(clip_, frame, offers_[i]), 1, static_cast<std::uint32_t>(frame),
                        std::llround(clip_.times[static_cast<std::size_t>(frame)] * 1e6));
    }
  }
  void WatchAll(RawClient& watcher) const {
    for (int i = 0; i < kSubjects; ++i) {
      const auto reply = Watch(watcher, {.subject = "subject " + std::to_string(i)},
                               static_cast<std::uint32_t>(i + 1));
      ASSERT_TRUE(reply.has_value());
    }
  }
  // Receives one correct frame of every subject, in any order.
  void Expect(RawClient& watcher, int frame) const {
    std::map<std::uint16_t, int> seen;
    for (int i = 0; i < kSubjects; ++i) {
      protocol::Header header;
      const auto weights = watcher.Await<protocol::WeightFrame>(&header);
      ASSERT_TRUE(weights.has_value());
      ASSERT_EQ(header.sequence, static_cast<std::uint32_t>(frame));
      ASSERT_EQ(++seen[header.stream], 1);
      const auto& expected = expected_[static_cast<std::size_t>(frame)];
      ASSERT_EQ(weights->values.size(), expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k)
        ASSERT_NEAR(weights->values[k], expected[k], 1e-5) << frame << " " << k;
    }
  }
  [[nodiscard]] RawClient& sender(std::size_t i) { return *senders_[i]; }

 private:
  const motion::Clip clip_ = ArkitClip(kFrames);
  const std::vector<std::vector<float>> expected_ = Solve(clip_, "arkit.json");
  std::vector<protocol::SkeletonOffer> offers_;
  std::vector<std::unique_ptr<RawClient>> senders_;
};

class Threads : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Counts, Threads, testing::Values(1, 2, 3));

TEST_P(Threads, EverySubscriberReceivesEveryPoseOnceAndInOrder) {
  DaemonThread daemon(Threaded(GetParam()));
  ASSERT_TRUE(daemon.serves());
  Troupe troupe(daemon.ready());
  std::vector<std::unique_ptr<RawClient>> watchers;
  for (int i = 0; i < kWatchers; ++i) {
    if (i % 4 == 3) {
      watchers.push_back(std::make_unique<TcpClient>(daemon.ready().tcp));
    } else {
      auto watcher = std::make_unique<UdpClient>(daemon.ready().udp);
      ASSERT_TRUE(watcher->Prove(/*bundles=*/i % 2 == 0));
      watchers.push_back(std::move(watcher));
    }
    troupe.WatchAll(*watchers.back());
    if (HasFatalFailure()) return;
  }
  for (int frame = 0; frame < kFrames; ++frame) {
    troupe.Send(frame);
    for (const auto& watcher : watchers) {
      troupe.Expect(*watcher, frame);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_EQ(daemon.Count(server::Counter::kPosesReceived), std::uint64_t{kSubjects * kFrames});
  EXPECT_EQ(daemon.Count(server::Counter::kWeightsSent),
            std::uint64_t{kWatchers * kSubjects * kFrames});
}

TEST_P(Threads, ASubjectMovesBetweenSenders) {
  DaemonThread daemon(Threaded(GetParam()));
  const motion::Clip clip = ArkitClip(kFrames);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  const auto expected = Solve(clip, "arkit.json");
  std::deque<UdpClient> senders;
  TcpClient watcher(daemon.ready().tcp);
  for (int turn = 0; turn < kSubjects; ++turn) {
    UdpClient& sender = senders.emplace_back(daemon.ready().udp);
    sender.session += static_cast<std::uint64_t>(turn);
    Offer(sender, offer);
    if (turn == 0) {
      ASSERT_TRUE(Watch(watcher, {.subject = "ann"}).has_value());
    }
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      sender.Send(PoseOf(clip, static_cast<int>(frame), offer), 1, frame,
                  std::llround(clip.times[frame] * 1e6));
      protocol::Header header;
      const auto weights = watcher.Await<protocol::WeightFrame>(&header);
      ASSERT_TRUE(weights.has_value());
      ASSERT_EQ(header.sequence, frame) << turn;
      ASSERT_EQ(weights->values.size(), expected[frame].size());
      for (std::size_t k = 0; k < weights->values.size(); ++k)
        ASSERT_NEAR(weights->values[k], expected[frame][k], 1e-5);
    }
    if (turn > 0) {
      UdpClient& former = senders[static_cast<std::size_t>(turn) - 1];
      former.Send(PoseOf(clip, 3, offer), 1, 3);
      const auto reply = former.Await<protocol::SkeletonReply>();
      ASSERT_TRUE(reply.has_value());
      ASSERT_EQ(reply->status, protocol::SkeletonStatus::kNeeded) << turn;
      former.Send(offer, 1);
      const auto error = former.Await<protocol::ErrorMessage>();
      ASSERT_TRUE(error.has_value());
      ASSERT_EQ(error->code, protocol::ErrorCode::kSubjectTaken) << turn;
    }
    sender.Send(protocol::Goodbye{}, 1);
  }
  EXPECT_EQ(daemon.Count(server::Counter::kSubjectsRestarted), std::uint64_t{kSubjects - 1});
}

TEST_P(Threads, AWaitingSubscriberFollowsItsSubject) {
  DaemonThread daemon(Threaded(GetParam()));
  std::deque<UdpClient> watchers;
  for (int i = 0; i < kSubjects; ++i) {
    UdpClient& watcher = watchers.emplace_back(daemon.ready().udp);
    ASSERT_TRUE(watcher.Prove());
    const std::string name = "subject " + std::to_string(i);
    const auto reply = Watch(watcher, {.subject = name, .wait = true});
    ASSERT_TRUE(reply.has_value());
    EXPECT_TRUE(reply->names.empty());
  }
  Troupe troupe(daemon.ready());
  for (UdpClient& watcher : watchers) {
    const auto reply = watcher.Await<protocol::SubscribeReply>();
    ASSERT_TRUE(reply.has_value());
    EXPECT_FALSE(reply->names.empty());
  }
  for (std::size_t i = 0; i < watchers.size(); ++i) {
    troupe.sender(i).Send(protocol::Goodbye{protocol::GoodbyeReason::kDone}, 1);
  }
  for (UdpClient& watcher : watchers) {
    const auto goodbye = watcher.Await<protocol::Goodbye>();
    ASSERT_TRUE(goodbye.has_value());
    EXPECT_EQ(goodbye->reason, protocol::GoodbyeReason::kSubjectGone);
  }
}

TEST_P(Threads, ARecordingHasThePosesOfAllThreads) {
  const TemporaryFolder folder;
  {
    server::Config config = Threaded(GetParam());
    config.record.folder = folder.path();
    DaemonThread daemon(config);
    ASSERT_TRUE(daemon.serves());
    Troupe troupe(daemon.ready());
    UdpClient watcher(daemon.ready().udp);
    ASSERT_TRUE(watcher.Prove());
    troupe.WatchAll(watcher);
    for (int frame = 0; frame < kFrames; ++frame) {
      troupe.Send(frame);
      troupe.Expect(watcher, frame);
      if (HasFatalFailure()) return;
    }
    EXPECT_EQ(daemon.Count(server::Counter::kRecordingDropped), 0u);
  }
  const auto file = std::filesystem::directory_iterator(folder.path())->path();
  const auto take = recording::TakeReader::Open(file);
  ASSERT_TRUE(take.ok()) << take.status().ToString();
  const auto summary = recording::Summarise(**take);
  ASSERT_TRUE(summary.ok()) << summary.status().ToString();
  ASSERT_EQ(summary->subjects.size(), std::size_t{kSubjects});
  for (const auto& [name, subject] : summary->subjects) {
    EXPECT_EQ(subject.poses, std::uint64_t{kFrames}) << name;
    EXPECT_EQ(subject.weights, std::uint64_t{kFrames}) << name;
  }
}

TEST_P(Threads, EveryPeerReceivesAGoodbye) {
  DaemonThread daemon(Threaded(GetParam()));
  std::deque<UdpClient> peers;
  for (int i = 0; i < kSubjects; ++i) {
    ASSERT_TRUE(peers.emplace_back(daemon.ready().udp).Prove());
  }
  EXPECT_EQ(daemon.Stop(), server::ExitCode::kOk);
  for (UdpClient& peer : peers) {
    const auto goodbye = peer.Await<protocol::Goodbye>();
    ASSERT_TRUE(goodbye.has_value());
    EXPECT_EQ(goodbye->reason, protocol::GoodbyeReason::kDraining);
  }
}

}  // namespace
}  // namespace furrow::testing_net
