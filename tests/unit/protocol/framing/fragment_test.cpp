// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/fragment.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Bytes;

std::vector<Bytes> Split(const Bytes& message, std::uint32_t id) {
  std::vector<Bytes> datagrams;
  for (std::size_t i = 0; i < NumDatagrams(message.size()); ++i) {
    Bytes datagram(kMaxDatagramBytes);
    datagram.resize(WriteDatagram(message, id, i, datagram));
    datagrams.push_back(datagram);
  }
  return datagrams;
}

Bytes LargeMessage() { return test::Encoded(test::MakeOffer(163, 0)); }

class Fragments : public ::testing::Test {
 protected:
  FragmentStatus Push(const Bytes& datagram, std::uint64_t peer = 1, std::int64_t now = 0) {
    return reassembler_.Push(peer, datagram, now, message_);
  }
  Reassembler reassembler_;
  std::span<const std::uint8_t> message_;
};

TEST_F(Fragments, SmallMessageIsOneDatagram) {
  const Bytes ping = test::Encoded(Ping{1});
  ASSERT_EQ(NumDatagrams(ping.size()), 1u);
  EXPECT_EQ(Split(ping, 9).front(), ping);
  EXPECT_EQ(Push(ping), FragmentStatus::kWhole);
  EXPECT_EQ(Bytes(message_.begin(), message_.end()), ping);
}

TEST_F(Fragments, ReassembleInAnyOrderDespiteDuplicates) {
  const Bytes message = LargeMessage();
  std::vector<Bytes> datagrams = Split(message, 9);
  ASSERT_GT(datagrams.size(), 5u);
  for (std::size_t i = 0; i + 1 < datagrams.size(); ++i) {
    EXPECT_EQ(datagrams[i].size(), kMaxDatagramBytes);
  }
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(datagrams.begin(), datagrams.end(), random);
    for (std::size_t i = 0; i + 1 < datagrams.size(); ++i) {
      EXPECT_EQ(Push(datagrams[i]), FragmentStatus::kPending);
      EXPECT_EQ(Push(datagrams[i]), FragmentStatus::kDuplicate);
    }
    ASSERT_EQ(Push(datagrams.back()), FragmentStatus::kComplete);
    EXPECT_EQ(Bytes(message_.begin(), message_.end()), message);
    EXPECT_EQ(reassembler_.pending_messages(), 0u);
    EXPECT_EQ(reassembler_.pending_bytes(), 0u);
  }
}

TEST_F(Fragments, PeersAndMessagesDoNotMix) {
  const std::vector<Bytes> first = Split(LargeMessage(), 1);
  const std::vector<Bytes> second = Split(LargeMessage(), 2);
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    EXPECT_EQ(Push(first[i], 1), FragmentStatus::kPending);
    EXPECT_EQ(Push(first[i], 2), FragmentStatus::kPending);
    EXPECT_EQ(Push(second[i], 1), FragmentStatus::kPending);
  }
  EXPECT_EQ(reassembler_.pending_messages(), 3u);
  EXPECT_EQ(Push(first.back(), 2), FragmentStatus::kComplete);
  reassembler_.ForgetPeer(1);
  EXPECT_EQ(reassembler_.pending_messages(), 0u);
}

TEST_F(Fragments, RejectContradictoryNumbers) {
  const Bytes good = Split(LargeMessage(), 1).front();
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes bad = good;
    bad[at] = value;
    return Push(bad);
  };
  EXPECT_EQ(with(36, 200), FragmentStatus::kMalformed) << "index beyond count";
  EXPECT_EQ(with(38, 200), FragmentStatus::kMalformed) << "count against payload size";
  EXPECT_EQ(with(22, 0xFF), FragmentStatus::kMalformed) << "payload above the limit";
  EXPECT_EQ(with(23, 0xFF), FragmentStatus::kMalformed);
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_EQ(Push(longer), FragmentStatus::kMalformed);
  Bytes needless = test::Encoded(Ping{1});
  needless[5] = kFlagFragment;
  EXPECT_EQ(Push(needless), FragmentStatus::kMalformed);
  test::ForEveryTruncation(good, [this](std::span<const std::uint8_t> cut) {
    const FragmentStatus status = reassembler_.Push(1, cut, 0, message_);
    EXPECT_EQ(status,
              cut.size() < kEnvelopeBytes ? FragmentStatus::kWhole : FragmentStatus::kMalformed);
  });
  EXPECT_EQ(reassembler_.pending_messages(), 0u);
}

TEST_F(Fragments, RejectDifferingEnvelope) {
  const std::vector<Bytes> datagrams = Split(LargeMessage(), 1);
  ASSERT_EQ(Push(datagrams[0]), FragmentStatus::kPending);
  Bytes other = datagrams[1];
  other[16] ^= 1;  // sequence
  EXPECT_EQ(Push(other), FragmentStatus::kMalformed);
  EXPECT_EQ(Push(datagrams[1]), FragmentStatus::kPending);
}

TEST_F(Fragments, MemoryIsBoundedPerPeerAndInTotal) {
  const Bytes message = LargeMessage();
  for (std::uint32_t id = 0; id < 100; ++id) (void)Push(Split(message, id).front(), 1, id);
  EXPECT_EQ(reassembler_.pending_messages(), ReassemblyLimits{}.max_pending_per_peer);
  // The oldest message was dropped; the newest one still completes.
  const std::vector<Bytes> newest = Split(message, 99);
  for (std::size_t i = 1; i + 1 < newest.size(); ++i) (void)Push(newest[i], 1, 200);
  EXPECT_EQ(Push(newest.back(), 1, 200), FragmentStatus::kComplete);
  // First fragments from many peers evict each other. A complete message still gets through.
  for (std::uint64_t peer = 10; peer < 5000; ++peer) {
    ASSERT_EQ(Push(newest.front(), peer, 300), FragmentStatus::kPending);
    ASSERT_LE(reassembler_.pending_bytes(), ReassemblyLimits{}.max_total_bytes);
  }
  for (std::size_t i = 0; i + 1 < newest.size(); ++i) (void)Push(newest[i], 1, 300);
  EXPECT_EQ(Push(newest.back(), 1, 300), FragmentStatus::kComplete);
  EXPECT_EQ(Bytes(message_.begin(), message_.end()), message);
  // Started: 100 messages of one peer, 4,990 of others and one more. Completed: two.
  const std::size_t left = reassembler_.pending_messages();
  EXPECT_EQ(reassembler_.Expire(300), 100u + 4990u + 1u - 2u - left);
}

TEST(ReassemblerLimits, RejectsAMessageAboveTheTotal) {
  Reassembler small({.max_total_bytes = 2000});
  std::span<const std::uint8_t> message;
  EXPECT_EQ(small.Push(1, Split(LargeMessage(), 1).front(), 0, message),
            FragmentStatus::kOverLimit);
  EXPECT_EQ(small.pending_bytes(), 0u);
}

TEST_F(Fragments, OldMessagesExpire) {
  const std::vector<Bytes> datagrams = Split(LargeMessage(), 1);
  (void)Push(datagrams[0], 1, 0);
  (void)Push(datagrams[0], 2, 900'000);
  EXPECT_EQ(reassembler_.Expire(1'000'000), 0u);
  EXPECT_EQ(reassembler_.Expire(1'000'001), 1u);
  EXPECT_EQ(reassembler_.pending_messages(), 1u);
}

}  // namespace
}  // namespace furrow::protocol
