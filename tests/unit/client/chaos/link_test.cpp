// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/link.h"

#include <cmath>

#include <gtest/gtest.h>

#include "chaos_testing.h"
#include "protocol/framing/fragment.h"

namespace furrow::chaos {
namespace {

Packet Numbered(int number) {
  return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8)};
}
int Number(const Packet& packet) { return packet[0] + 256 * packet[1]; }

// Pushes `count` packets, one per millisecond, and returns all packets that leave within a minute.
std::vector<int> Pass(Link& link, int count) {
  std::vector<int> out;
  Packet packet;
  for (int i = 0; i < count; ++i) {
    link.Push(Numbered(i), i * 1000);
    while (link.Pop(i * 1000, &packet)) out.push_back(Number(packet));
  }
  while (link.Pop(count * 1000 + 60'000'000, &packet)) out.push_back(Number(packet));
  EXPECT_EQ(link.next_us(), -1);
  return out;
}

TEST(Link, WithoutFaultsAllPacketsPassAtOnceInOrder) {
  Link link({}, 0, 0);
  const auto out = Pass(link, 100);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(out[static_cast<std::size_t>(i)], i);
}

TEST(Link, TheSameSeedRepeatsTheFaultsAndAnotherDoesNot) {
  const Faults options{.seed = 3, .loss = 0.1, .reorder = 0.1, .duplicate = 0.1, .jitter_ms = 5.0};
  const auto run = [](Faults with, std::uint64_t seed, std::uint64_t number) {
    with.seed = seed;
    Link link(with, number, 0);
    return Pass(link, 500);
  };
  EXPECT_EQ(run(options, 3, 0), run(options, 3, 0));
  EXPECT_NE(run(options, 3, 0), run(options, 4, 0));
  EXPECT_NE(run(options, 3, 0), run(options, 3, 1));
}

TEST(Link, LosesTheRequestedShare) {
  Link link({.loss = 0.2}, 0, 0);
  const auto out = Pass(link, 10000);
  // Four standard deviations of the binomial distribution.
  EXPECT_NEAR(static_cast<double>(link.counts().lost), 2000.0, 4.0 * std::sqrt(1600.0));
  EXPECT_EQ(out.size() + link.counts().lost, 10000u);
}

TEST(Link, LostAndDelayedWeightsAreCountedApart) {
  Link losing({.loss = 1.0}, 0, 0);
  Link delaying({.delay = 1.0}, 0, 0);
  for (Link* link : {&losing, &delaying}) {
    link->Push(Weights(1, {0.5f}), 0);
    link->Push(Numbered(7), 0);  // not a message
    link->Push(Weights(2, {0.5f}), 0);
  }
  EXPECT_EQ(losing.counts().lost, 3u);
  EXPECT_EQ(losing.counts().lost_data, 2u);
  EXPECT_EQ(delaying.counts().delayed, 3u);
  EXPECT_EQ(delaying.counts().delayed_data, 2u);
}

TEST(Link, AReorderedPacketFollowsTheNextPacket) {
  Link link({.reorder = 0.05}, 0, 0);
  const auto out = Pass(link, 2000);
  ASSERT_EQ(out.size(), 2000u);
  std::uint64_t descents = 0;
  for (std::size_t i = 1; i < out.size(); ++i) {
    if (out[i] > out[i - 1]) continue;
    EXPECT_EQ(out[i] + 1, out[i - 1]);
    ++descents;
  }
  EXPECT_GT(descents, 50u);
  EXPECT_EQ(descents, link.counts().reordered);
}

TEST(Link, AReorderedPacketWithoutASuccessorIsReleased) {
  Link link({.reorder = 1.0}, 0, 0);
  link.Push(Numbered(7), 0);
  Packet packet;
  EXPECT_FALSE(link.Pop(Link::kLongestHoldUs - 1, &packet));
  ASSERT_TRUE(link.Pop(Link::kLongestHoldUs, &packet));
  EXPECT_EQ(Number(packet), 7);
  EXPECT_EQ(link.counts().reordered, 0u);
}

TEST(Link, DelayHoldsBackTheSelectedPackets) {
  Link link({.delay = 1.0, .delay_ms = 20.0}, 0, 0);
  link.Push(Numbered(1), 1000);
  Packet packet;
  EXPECT_EQ(link.next_us(), 21000);
  EXPECT_FALSE(link.Pop(20999, &packet));
  EXPECT_TRUE(link.Pop(21000, &packet));
  EXPECT_EQ(link.counts().delayed, 1u);
}

TEST(Link, ADuplicatedPacketLeavesTwice) {
  Link link({.duplicate = 1.0}, 0, 0);
  EXPECT_EQ(Pass(link, 3), (std::vector<int>{0, 0, 1, 1, 2, 2}));
}

TEST(Link, APeriodicBlackHoleSwallowsPackets) {
  Link link({.black_holes = {{.start = 0.0095, .length = 0.005, .every = 0.020}}}, 0, 0);
  const auto out = Pass(link, 40);
  std::vector<int> expected;
  for (int i = 0; i < 40; ++i) {
    const bool swallowed = i >= 10 && (i - 10) % 20 < 5;
    if (!swallowed) expected.push_back(i);
  }
  EXPECT_EQ(out, expected);
  EXPECT_EQ(link.counts().swallowed, 10u);
}

TEST(Link, FalsifiesOneWeightAndLeavesTheMessageValid) {
  Link link({.falsify = 1.0}, 0, 0);
  link.Push(Weights(4, {0.1f, 0.2f, 0.9f}), 0);
  Packet packet;
  ASSERT_TRUE(link.Pop(0, &packet));
  std::uint32_t sequence = 0;
  const auto values = ValuesOf(packet, &sequence);
  EXPECT_EQ(sequence, 4u);
  ASSERT_EQ(values.size(), 3u);
  int changed = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const float was = std::vector<float>{0.1f, 0.2f, 0.9f}[i];
    if (values[i] != was) ++changed;
    EXPECT_TRUE(values[i] >= 0.0f && values[i] <= 1.0f);
  }
  EXPECT_EQ(changed, 1);
}

TEST(Link, SwapsContentsButNotEnvelopes) {
  Link link({.swap = 1.0}, 0, 0);
  link.Push(Weights(1, {0.1f}), 0);
  Packet packet;
  EXPECT_FALSE(link.Pop(0, &packet));
  link.Push(Numbered(9), 1);  // not a message, so it passes
  ASSERT_TRUE(link.Pop(1, &packet));
  EXPECT_EQ(Number(packet), 9);
  link.Push(Weights(2, {0.2f}), 2);
  std::uint32_t sequence = 0;
  ASSERT_TRUE(link.Pop(2, &packet));
  EXPECT_EQ(ValuesOf(packet, &sequence), (std::vector<float>{0.2f}));
  EXPECT_EQ(sequence, 1u);
  ASSERT_TRUE(link.Pop(2, &packet));
  EXPECT_EQ(ValuesOf(packet, &sequence), (std::vector<float>{0.1f}));
  EXPECT_EQ(sequence, 2u);
  EXPECT_EQ(link.counts().swapped, 2u);
}

// A pose message that takes two datagrams.
std::vector<Packet> Fragments(std::uint32_t sequence, int joints = 100) {
  Packet message;
  protocol::Encoder().Encode({.session = 5, .stream = 1, .sequence = sequence}, WholeBody(joints),
                             message);
  std::vector<Packet> fragments;
  for (std::size_t i = 0; i < protocol::NumDatagrams(message.size()); ++i) {
    Packet& fragment = fragments.emplace_back(protocol::kMaxDatagramBytes);
    fragment.resize(protocol::WriteDatagram(message, 70 + sequence, i, fragment));
  }
  EXPECT_EQ(fragments.size(), 2u);
  return fragments;
}

// Reassembles all messages that leave a link now.
std::vector<Packet> Leave(Link& link, std::int64_t now_us) {
  protocol::Reassembler reassembler;
  std::vector<Packet> messages;
  std::span<const std::uint8_t> message;
  Packet packet;
  while (link.Pop(now_us, &packet)) {
    EXPECT_LE(packet.size(), protocol::kMaxDatagramBytes);
    const auto status = reassembler.Push({}, packet, now_us, message);
    if (status == protocol::FragmentStatus::kPending) continue;
    EXPECT_TRUE(status == protocol::FragmentStatus::kWhole ||
                status == protocol::FragmentStatus::kComplete);
    messages.emplace_back(message.begin(), message.end());
  }
  EXPECT_EQ(reassembler.pending_messages(), 0u);
  return messages;
}

int NumTurned(const protocol::PoseFrame& pose) {
  const protocol::PoseFrame was = WholeBody(pose.num_joints);
  int turned = 0;
  for (std::size_t i = 0; i < was.rotations.size(); ++i)
    turned += pose.rotations[i] == was.rotations[i] ? 0 : 1;
  return turned;
}

TEST(Link, AFragmentedPoseIsFalsified) {
  Link link({.falsify = 1.0}, 0, 0);
  const auto fragments = Fragments(4);
  link.Push(fragments[0], 0);
  EXPECT_TRUE(Leave(link, 0).empty());
  link.Push(fragments[1], 1);
  const auto messages = Leave(link, 1);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(NumTurned(PoseOf(messages[0])), 1);
  EXPECT_EQ(link.counts().packets, 2u);
  EXPECT_EQ(link.counts().falsified, 1u);
}

TEST(Link, FragmentedPosesSwapContents) {
  Link link({.swap = 1.0}, 0, 0);
  for (const Packet& fragment : Fragments(1, 100)) link.Push(fragment, 0);
  EXPECT_TRUE(Leave(link, 0).empty());
  for (const Packet& fragment : Fragments(2, 110)) link.Push(fragment, 1);
  const auto messages = Leave(link, 1);
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(PoseOf(messages[0]).num_joints, 110);
  EXPECT_EQ(PoseOf(messages[1]).num_joints, 100);
  EXPECT_EQ(link.counts().swapped, 2u);
}

TEST(Link, AMessageThatLostAFragmentIsDropped) {
  Link link({.falsify = 1e-9}, 0, 0);
  for (std::uint32_t i = 0; i < 20; ++i) link.Push(Fragments(i)[0], 0);
  for (const Packet& fragment : Fragments(20)) link.Push(fragment, 1);
  const auto messages = Leave(link, 60'000'000);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(NumTurned(PoseOf(messages[0])), 0);
}

TEST(Link, FragmentsPassUnchangedIfNoContentChanges) {
  Link link({.duplicate = 1e-9}, 0, 0);
  const auto fragments = Fragments(1);
  Packet packet;
  for (const Packet& fragment : fragments) {
    link.Push(fragment, 0);
    ASSERT_TRUE(link.Pop(0, &packet));
    EXPECT_EQ(packet, fragment);
  }
}

TEST(Link, ALargePacketThatIsNotAMessagePassesWhole) {
  Link link({.falsify = 1.0, .swap = 1.0}, 0, 0);
  const Packet large(5000, 7);
  link.Push(large, 0);
  Packet packet;
  ASSERT_TRUE(link.Pop(0, &packet));
  EXPECT_EQ(packet, large);
}

TEST(BlackHole, IsParsedOrRejected) {
  const auto once = ParseBlackHole("1.5:2");
  ASSERT_TRUE(once.ok());
  EXPECT_EQ(once->start, 1.5);
  EXPECT_EQ(once->length, 2.0);
  EXPECT_EQ(once->every, 0.0);
  ASSERT_TRUE(ParseBlackHole("0:1:3").ok());
  EXPECT_EQ(ParseBlackHole("0:1:3")->every, 3.0);
  for (const char* bad : {"", "1", "1:", "1:0", "-1:2", "1:2:", "1:2:1", "1:2x", "a:b", "nan:1"})
    EXPECT_FALSE(ParseBlackHole(bad).ok()) << bad;
}

}  // namespace
}  // namespace furrow::chaos
