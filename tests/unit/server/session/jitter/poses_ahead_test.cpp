// SPDX-License-Identifier: Apache-2.0
// Poses that overtook earlier ones wait for them, in simulated time.
#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

class PosesAheadTest : public HubPeersTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&sender, Transport::kUdp);
    Connect(&viewer);
    Publish(sender, "ann");
    ASSERT_NE(Watch(viewer, {.subject = "ann"}), 0);
  }
  static float BrowOf(std::uint32_t sequence) { return static_cast<float>(sequence % 97) / 97.0f; }
  void SendPose(std::uint32_t sequence) {
    Send(sender, Pose(BrowOf(sequence)), 1, sequence,
         5'000'000 + sequence * std::int64_t{16'667});
  }
  // Sends poses at the same time; returns the sequences of the weights that they caused.
  std::vector<std::uint32_t> SendPoses(const std::vector<std::uint32_t>& sequences) {
    for (const std::uint32_t sequence : sequences) SendPose(sequence);
    return Received();
  }
  std::vector<std::uint32_t> Received() {
    std::vector<std::uint32_t> sequences;
    while (const auto frame = viewer.Take<protocol::WeightFrame>()) {
      const std::uint32_t sequence = frame->header.sequence;
      sequences.push_back(sequence);
      EXPECT_FLOAT_EQ(frame->message.values[0], BrowOf(sequence));
    }
    return sequences;
  }
  // From now on, poses of the stream wait. The next sequence is 3.
  void Overtake() { ASSERT_EQ(SendPoses({0, 2, 1}), (std::vector<std::uint32_t>{0, 2})); }

  using Sequences = std::vector<std::uint32_t>;
};

TEST_F(PosesAheadTest, AfterOneWasOvertakenTheNextOnesWait) {
  Overtake();
  EXPECT_EQ(Count(Counter::kPosesLate), 1u);
  EXPECT_EQ(SendPoses({3, 5}), Sequences{3});
  EXPECT_EQ(hub->NextAhead(0), now + milliseconds(2));
  Advance(0.001);
  EXPECT_EQ(SendPoses({4}), (Sequences{4, 5}));
  EXPECT_EQ(hub->NextAhead(0), std::nullopt);
  EXPECT_EQ(Count(Counter::kPosesLate), 1u);
}

TEST_F(PosesAheadTest, NobodyWaitsLongerThanTwoMilliseconds) {
  Overtake();
  EXPECT_EQ(SendPoses({4, 6}), Sequences{});
  Advance(0.001);
  // It waits for 3, too, but 6 must not wait any longer.
  EXPECT_EQ(SendPoses({5, 9}), Sequences{});
  Advance(0.001);
  hub->ReleaseHeld(0, now);
  EXPECT_EQ(Received(), (Sequences{4, 5, 6}));
  EXPECT_EQ(hub->NextAhead(0), now + milliseconds(1)) << "9 waits for 7 and 8";
  EXPECT_EQ(SendPoses({3}), Sequences{}) << "too late";
  Advance(0.001);
  hub->ReleaseHeld(0, now);
  EXPECT_EQ(Received(), Sequences{9});
  EXPECT_EQ(hub->NextAhead(0), std::nullopt);
}

TEST_F(PosesAheadTest, LossAloneCostsNoTime) {
  EXPECT_EQ(SendPoses({0, 2, 5, 9, 11}), (Sequences{0, 2, 5, 9, 11}));
  EXPECT_EQ(SendPoses({11, 13}), Sequences{13}) << "a duplicate overtakes nothing";
  EXPECT_EQ(SendPoses({15}), Sequences{15});
}

TEST_F(PosesAheadTest, APoseThatComesTooLateToWaitForIsNoReason) {
  EXPECT_EQ(SendPoses({0, 2}), (Sequences{0, 2}));
  Advance(0.003);
  EXPECT_EQ(SendPoses({1, 4}), Sequences{4});
}

TEST_F(PosesAheadTest, StopsFiveSecondsAfterTheLastTime) {
  Overtake();
  Advance(4.9);
  EXPECT_EQ(SendPoses({4, 3}), (Sequences{3, 4}));
  Advance(4.9);
  EXPECT_EQ(SendPoses({6}), Sequences{});
  Advance(0.002);
  hub->ReleaseHeld(0, now);
  EXPECT_EQ(Received(), Sequences{6});
  Advance(0.1);
  EXPECT_EQ(SendPoses({8}), Sequences{8});
}

TEST_F(PosesAheadTest, OrderedTransportsNeverWait) {
  FakePeer tcp;
  tcp.session = 78;
  Connect(&tcp);
  Publish(tcp, "ben");
  ASSERT_NE(Watch(viewer, {.subject = "ben"}, 2), 0);
  for (const std::uint32_t sequence : {0, 2, 1, 3, 5}) {
    Send(tcp, Pose(BrowOf(sequence)), 1, sequence);
  }
  EXPECT_EQ(Received(), (Sequences{0, 2, 3, 5}));
}

TEST_F(PosesAheadTest, DuplicatesOfAWaitingPoseAreDropped) {
  Overtake();
  EXPECT_EQ(SendPoses({4, 4, 4, 3}), (Sequences{3, 4}));
  EXPECT_EQ(Count(Counter::kPosesDuplicate), 2u);
}

TEST_F(PosesAheadTest, AGoodbyeTakesWaitingPosesAlong) {
  Overtake();
  EXPECT_EQ(SendPoses({4}), Sequences{});
  Send(sender, protocol::Goodbye{}, 1);
  EXPECT_EQ(Received(), Sequences{4});
  EXPECT_EQ(hub->NextAhead(0), std::nullopt);
}

TEST_F(PosesAheadTest, AnotherSkeletonForgetsWaitingPoses) {
  Overtake();
  EXPECT_EQ(SendPoses({4}), Sequences{});
  protocol::SkeletonOffer other = Offer("ann");
  other.blend_shape_names.push_back("jaw");
  other.skeleton_hash = protocol::SkeletonHash(other);
  Send(sender, other, 1);
  Advance(0.002);
  hub->ReleaseHeld(0, now);
  while (!viewer.inbox.empty()) viewer.inbox.pop_front();
  EXPECT_EQ(hub->NextAhead(0), std::nullopt);
}

TEST_F(PosesAheadTest, ManyWaitingPosesAreBounded) {
  Overtake();
  Sequences odd;
  for (std::uint32_t sequence = 4; odd.size() < 300; sequence += 2) odd.push_back(sequence);
  EXPECT_EQ(SendPoses(odd), Sequences{});
  EXPECT_EQ(Count(Counter::kPosesHeldFull), 300u - 256u);
  EXPECT_LE(*hub->NextAhead(0), now) << "what found no room leaves at once";
  hub->ReleaseHeld(0, now);
  EXPECT_EQ(Received().size(), 300u - 256u);
}

// 10% loss, 20% reordering, 5% duplicates and up to 50 ms of jitter. Reordered datagrams are sent
// directly after the next one.
TEST_F(PosesAheadTest, ABadNetworkLosesFewerPosesOfASingleSubject) {
  constexpr std::uint32_t kPoses = 5000;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> dice(0.0, 1.0);
  std::multimap<Time, std::uint32_t> arrivals;
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t overtaken = kNone;
  for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
    if (dice(random) < 0.1) continue;
    const Time at = now + microseconds(pose * 16'667) + FromSeconds(0.05 * dice(random));
    if (overtaken == kNone && dice(random) < 0.2) {
      overtaken = pose;
      continue;
    }
    arrivals.emplace(at, pose);
    if (dice(random) < 0.05) arrivals.emplace(at, pose);
    if (overtaken == kNone) continue;
    arrivals.emplace(at, overtaken);
    overtaken = kNone;
  }
  Sequences received;
  const auto take = [&] {
    for (const std::uint32_t sequence : Received()) received.push_back(sequence);
  };
  const auto release_until = [&](Time end) {
    for (auto due = hub->NextAhead(0); due && *due <= end; due = hub->NextAhead(0)) {
      now = std::max(now, *due);
      hub->ReleaseHeld(0, now);
      take();
    }
  };
  for (const auto& [at, sequence] : arrivals) {
    release_until(at);
    now = at;
    SendPose(sequence);
    take();
  }
  release_until(now + milliseconds(2));
  EXPECT_EQ(std::ranges::adjacent_find(received, std::greater_equal<>()), received.end())
      << "in order, and each once";
  EXPECT_GE(received.size(), kPoses * 73 / 100) << "61% if nobody waits";
}

}  // namespace
}  // namespace furrow::server
