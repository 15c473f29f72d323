// SPDX-License-Identifier: Apache-2.0
// Jitter buffers within a hub, in simulated time.
#include "server/session/jitter/jitter_buffers.h"

#include <chrono>
#include <map>
#include <random>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

class JitterBuffersTest : public HubPeersTest {
 protected:
  void SetUp() override {
    jitter = {{"wifi*", 60.0}};
    HubPeersTest::SetUp();
    ASSERT_TRUE(hub->HoldsPoses());
  }
  void SendPose(std::uint32_t sequence, std::uint16_t stream = 1) {
    Send(sender, Pose(1e-3f * static_cast<float>(sequence)), stream, sequence,
         5'000'000 + sequence * std::int64_t{16'667});
  }
  // The sequences of all weights that arrived.
  std::vector<std::uint32_t> Received() {
    std::vector<std::uint32_t> sequences;
    while (const auto frame = viewer.Take<protocol::WeightFrame>()) {
      if (frame->message.age_us == 0) sequences.push_back(frame->header.sequence);
    }
    return sequences;
  }
};

// 10% loss, 20% reordering, 5% duplicates and up to 50 ms of jitter. Without a buffer, about a
// quarter of what arrives is late.
TEST_F(JitterBuffersTest, HardlyAnyPoseThatArrivesIsLate) {
  constexpr std::uint32_t kPoses = 1000;
  Publish(sender, "wifi");
  ASSERT_NE(Watch(viewer, {.subject = "wifi"}), 0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> dice(0.0, 1.0);
  std::multimap<Time, std::uint32_t> arrivals;
  std::size_t arrived = 0;
  for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
    Time at = now + microseconds(pose * 16'667) + FromSeconds(0.05 * dice(random));
    if (dice(random) < 0.1) continue;
    ++arrived;
    // Sent after the next datagram.
    if (dice(random) < 0.2) at += FromSeconds(0.0167 * dice(random));
    arrivals.emplace(at, pose);
    if (dice(random) < 0.05) arrivals.emplace(at, pose);
  }
  std::vector<std::uint32_t> received;
  for (const Time end = now + FromSeconds(18.0); now < end; now += milliseconds(2)) {
    for (; !arrivals.empty() && arrivals.begin()->first <= now; arrivals.erase(arrivals.begin())) {
      SendPose(arrivals.begin()->second);
    }
    hub->ReleaseHeld(0, now);
    for (const std::uint32_t pose : Received()) received.push_back(pose);
  }
  EXPECT_TRUE(std::ranges::is_sorted(received));
  EXPECT_GE(static_cast<double>(received.size()), 0.97 * static_cast<double>(arrived));
  EXPECT_EQ(
      Count(Counter::kPosesHeld) + Count(Counter::kPosesLate) + Count(Counter::kPosesDuplicate),
      Count(Counter::kPosesReceived));
}

TEST_F(JitterBuffersTest, OtherSubjectsAreNotHeld) {
  Publish(sender, "cable", 2);
  ASSERT_NE(Watch(viewer, {.subject = "cable"}), 0);
  SendPose(0, 2);
  EXPECT_EQ(Received(), std::vector<std::uint32_t>{0});
  EXPECT_EQ(Count(Counter::kPosesHeld), 0u);
}

TEST_F(JitterBuffersTest, AGoodbyeComesAfterThePosesBeforeIt) {
  Publish(sender, "wifi");
  ASSERT_NE(Watch(viewer, {.subject = "wifi"}), 0);
  SendPose(1);
  SendPose(0);
  EXPECT_TRUE(Received().empty());
  Send(sender, protocol::Goodbye{}, 1);
  EXPECT_EQ(Received(), (std::vector<std::uint32_t>{0, 1}));
}

TEST_F(JitterBuffersTest, ASubjectThatChangedHandsGetsNoHeldPose) {
  Publish(sender, "wifi");
  ASSERT_NE(Watch(viewer, {.subject = "wifi"}), 0);
  SendPose(0);
  hub->RemovePeer(sender.id);
  FakePeer other;
  Connect(&other);
  Publish(other, "wifi", 3);
  Advance(1.0);
  hub->ReleaseHeld(0, now);
  EXPECT_TRUE(Received().empty());
}

TEST_F(JitterBuffersTest, MemoryIsBounded) {
  JitterBuffers buffers;
  protocol::PoseFrame pose = Pose(0.5f);
  pose.rotations.resize(1000);
  std::uint64_t full = 0;
  for (std::uint32_t sequence = 0; sequence < 5000; ++sequence) {
    const StreamKey stream{1, 2, static_cast<std::uint16_t>(sequence % 50)};
    const auto place = buffers.Add(stream, {.sequence = sequence, .capture_time_us = 1}, pose, {},
                                   FromSeconds(1), now);
    full += place == JitterBuffers::Place::kFull ? 1 : 0;
    ASSERT_LE(buffers.bytes(), JitterBuffers::kMaxBytes);
  }
  EXPECT_GT(full, 1000u);
  EXPECT_EQ(buffers.TakeDue(now).size(), full);
  buffers.Recycle();
  EXPECT_EQ(buffers.TakeDue(now + FromSeconds(2)).size(), 5000u - full);
  EXPECT_EQ(buffers.bytes(), 0u);
  buffers.Recycle();
  EXPECT_TRUE(buffers.TakeDue(now + FromSeconds(20)).empty());
  EXPECT_TRUE(buffers.empty());
}

}  // namespace
}  // namespace furrow::server
