// SPDX-License-Identifier: Apache-2.0
// Poses that repeat the previous one (STANDARD.md section 7), in simulated time.
#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

constexpr std::int64_t kPeriodUs = 16'667;

class RedundancyTest : public HubPeersTest {
 protected:
  void Begin(double buffer_ms) {
    if (buffer_ms > 0.0) jitter = {{"*", buffer_ms}};
    HubPeersTest::SetUp();
    Publish(sender, "ann");
    ASSERT_NE(Watch(viewer, {.subject = "ann"}), 0);
  }
  void SetUp() override {}

  static std::vector<std::uint8_t> PayloadOf(const protocol::PoseFrame& pose) {
    protocol::Encoder encoder;
    std::vector<std::uint8_t> message;
    encoder.Encode({.session = 1}, pose, message);
    return {message.begin() + protocol::kEnvelopeBytes, message.end()};
  }
  static float BrowOf(std::uint32_t sequence) { return static_cast<float>(sequence % 97) / 97.0f; }
  void SendPose(std::uint32_t sequence) {
    protocol::PoseFrame pose = Pose(BrowOf(sequence));
    if (sequence > 0) {
      pose.previous = PayloadOf(Pose(BrowOf(sequence - 1)));
      pose.previous_age_us = static_cast<std::uint32_t>(kPeriodUs);
    }
    Send(sender, pose, 1, sequence, 9'000'000 + sequence * kPeriodUs);
  }
  // The sequences of the weights that arrived. Each must be that of its pose.
  std::vector<std::uint32_t> Received() {
    std::vector<std::uint32_t> sequences;
    while (const auto frame = viewer.Take<protocol::WeightFrame>()) {
      const std::uint32_t sequence = frame->header.sequence;
      if (frame->message.age_us > 0) continue;
      sequences.push_back(sequence);
      EXPECT_EQ(frame->header.capture_time_us, 9'000'000 + sequence * kPeriodUs);
      EXPECT_FLOAT_EQ(frame->message.values.front(), BrowOf(sequence)) << sequence;
    }
    return sequences;
  }
};

TEST_F(RedundancyTest, ALostPoseIsTakenFromTheNextOne) {
  Begin(0.0);
  for (const std::uint32_t sequence : {0, 2, 3, 6}) SendPose(sequence);
  EXPECT_EQ(Received(), (std::vector<std::uint32_t>{0, 1, 2, 3, 5, 6}));
  EXPECT_EQ(Count(Counter::kPosesRecovered), 2u);
  // Its own datagram comes after all.
  SendPose(5);
  EXPECT_TRUE(Received().empty());
  EXPECT_EQ(Count(Counter::kPosesDuplicate) + Count(Counter::kPosesLate), 1u);
}

TEST_F(RedundancyTest, AnInvalidPreviousPoseDoesNotSpoilThePose) {
  Begin(0.0);
  SendPose(0);
  EXPECT_EQ(Received(), std::vector<std::uint32_t>{0});
  const std::vector<std::uint8_t> valid = PayloadOf(Pose(0.25f));
  for (std::size_t length = 1; length < valid.size(); ++length) {
    protocol::PoseFrame pose = Pose(0.5f);
    pose.previous.assign(valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(length));
    Send(sender, pose, 1, static_cast<std::uint32_t>(2 * length), 9'000'000);
    const auto frame = viewer.Take<protocol::WeightFrame>();
    ASSERT_TRUE(frame.has_value()) << length;
    ASSERT_EQ(frame->header.sequence, 2 * length);
    ASSERT_TRUE(viewer.inbox.empty());
  }
  EXPECT_EQ(Count(Counter::kPosesInvalid), valid.size() - 1);
}

TEST_F(RedundancyTest, APartialOrRepeatingPreviousPoseIsRefused) {
  protocol::PoseFrame out;
  protocol::PoseFrame pose = Pose(0.5f);
  protocol::PoseFrame before = Pose(0.25f);
  pose.previous = PayloadOf(before);
  EXPECT_EQ(protocol::DecodePrevious(pose, out), protocol::DecodeStatus::kOk);
  EXPECT_EQ(out.blend_shapes, before.blend_shapes);
  before.partial = true;
  pose.previous = PayloadOf(before);
  EXPECT_EQ(protocol::DecodePrevious(pose, out), protocol::DecodeStatus::kBadValue);
  before = Pose(0.25f);
  before.previous = PayloadOf(Pose(0.0f));
  pose.previous = PayloadOf(before);
  EXPECT_EQ(protocol::DecodePrevious(pose, out), protocol::DecodeStatus::kBadValue);
  before = Pose(0.25f);
  before.skeleton_hash ^= 1;
  pose.previous = PayloadOf(before);
  EXPECT_EQ(protocol::DecodePrevious(pose, out), protocol::DecodeStatus::kBadValue);
}

// 10% loss and up to 50 ms of jitter, with a buffer of 60 ms. Without redundancy, 90% of the poses
// would be there.
TEST_F(RedundancyTest, WithABufferHardlyAnyPoseIsMissing) {
  constexpr std::uint32_t kPoses = 1000;
  Begin(60.0);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> dice(0.0, 1.0);
  std::multimap<Time, std::uint32_t> arrivals;
  for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
    const Time at = now + std::chrono::microseconds(pose * kPeriodUs);
    if (dice(random) >= 0.1) arrivals.emplace(at + FromSeconds(0.05 * dice(random)), pose);
  }
  std::vector<std::uint32_t> received;
  for (const Time end = now + FromSeconds(18.0); now < end; now += std::chrono::milliseconds(2)) {
    for (; !arrivals.empty() && arrivals.begin()->first <= now; arrivals.erase(arrivals.begin())) {
      SendPose(arrivals.begin()->second);
    }
    hub->ReleaseHeld(0, now);
    for (const std::uint32_t pose : Received()) received.push_back(pose);
  }
  EXPECT_TRUE(std::ranges::is_sorted(received));
  EXPECT_GE(received.size(), 970u);
}

}  // namespace
}  // namespace furrow::server
