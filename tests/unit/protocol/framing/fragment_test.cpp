// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/fragment.h"

#include <algorithm>
#include <map>
#include <new>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
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

// A message of two fragments.
Bytes MediumMessage(std::uint16_t stream, std::uint32_t sequence) {
  Encoder encoder;
  Bytes bytes;
  encoder.Encode({.session = 7, .stream = stream, .sequence = sequence}, test::MakeOffer(30, 0),
                 bytes);
  return bytes;
}

// A message of any size. The reassembler does not look into the payload.
Bytes MessageOfSize(std::size_t bytes) {
  Bytes message(bytes);
  Envelope envelope;
  envelope.header.session = 7;
  envelope.payload_bytes = static_cast<std::uint32_t>(bytes - kEnvelopeBytes);
  WriteEnvelope(envelope, std::span<std::uint8_t, kEnvelopeBytes>(message.data(), kEnvelopeBytes));
  return message;
}

Bytes LargeMessage() { return test::Encoded(test::MakeOffer(163, 0)); }

class Fragments : public ::testing::Test {
 protected:
  FragmentStatus Push(const Bytes& datagram, std::uint64_t peer = 1, std::int64_t now = 0) {
    return reassembler_.Push({.host = peer, .peer = peer}, datagram, now, message_);
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
  reassembler_.ForgetPeer({.host = 1, .peer = 1});
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
    const FragmentStatus status = reassembler_.Push({}, cut, 0, message_);
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

TEST_F(Fragments, MemoryIsBoundedPerStreamPeerAndInTotal) {
  const Bytes message = LargeMessage();
  const ReassemblyLimits limits;
  for (std::uint32_t id = 0; id < 100; ++id) {
    ASSERT_EQ(Push(Split(message, id).front(), 1, id), FragmentStatus::kPending);
    ASSERT_LE(reassembler_.pending_bytes(), limits.max_stream_bytes);
  }
  EXPECT_EQ(reassembler_.pending_messages(), limits.max_stream_bytes / message.size());
  // The oldest messages were dropped; the newest one still completes.
  const std::vector<Bytes> newest = Split(message, 99);
  for (std::size_t i = 1; i + 1 < newest.size(); ++i) (void)Push(newest[i], 1, 200);
  EXPECT_EQ(Push(newest.back(), 1, 200), FragmentStatus::kComplete);
  // A peer with many streams.
  for (std::uint16_t stream = 1; stream < 500; ++stream) {
    for (std::uint32_t id = 0; id < 5; ++id) {
      const Bytes other = Split(MediumMessage(stream, id), stream * 5u + id).front();
      ASSERT_EQ(Push(other, 1, 250), FragmentStatus::kPending);
    }
    ASSERT_LE(reassembler_.pending_bytes(), limits.max_peer_bytes);
  }
  EXPECT_GT(reassembler_.pending_bytes(), limits.max_peer_bytes / 2);
  reassembler_.ForgetPeer({.host = 1, .peer = 1});
  EXPECT_EQ(reassembler_.pending_bytes(), 0u);
  (void)reassembler_.Expire(250);
  // First fragments from many peers evict each other. A complete message still gets through.
  for (std::uint64_t peer = 10; peer < 5000; ++peer) {
    ASSERT_EQ(Push(newest.front(), peer, 300), FragmentStatus::kPending);
    ASSERT_LE(reassembler_.pending_bytes(), limits.max_total_bytes);
  }
  for (std::size_t i = 0; i + 1 < newest.size(); ++i) (void)Push(newest[i], 1, 300);
  EXPECT_EQ(Push(newest.back(), 1, 300), FragmentStatus::kComplete);
  EXPECT_EQ(Bytes(message_.begin(), message_.end()), message);
  // Started: 4,990 messages and one more. Completed: one.
  const std::size_t left = reassembler_.pending_messages();
  EXPECT_EQ(reassembler_.Expire(300), 4990u + 1u - 1u - left);
}

TEST_F(Fragments, AFloodFromAFewPeersTakesNothingFromOthers) {
  const Bytes message = LargeMessage();
  const std::vector<Bytes> datagrams = Split(message, 1);
  ASSERT_EQ(Push(datagrams[0]), FragmentStatus::kPending);
  std::uint32_t id = 0;
  // Twice the memory of all peers, in streams that do not shrink each other.
  for (std::size_t sent = 0; sent < 2 * ReassemblyLimits().max_total_bytes; ++id) {
    const Bytes flood = MediumMessage(static_cast<std::uint16_t>(id % 4096), id);
    (void)Push(Split(flood, id).front(), 10 + id % 9, 100);
    sent += flood.size();
  }
  EXPECT_GT(reassembler_.pending_bytes(), ReassemblyLimits().max_total_bytes * 9 / 10);
  for (std::size_t i = 1; i + 1 < datagrams.size(); ++i) (void)Push(datagrams[i], 1, 200);
  EXPECT_EQ(Push(datagrams.back(), 1, 200), FragmentStatus::kComplete);
  EXPECT_EQ(Bytes(message_.begin(), message_.end()), message);
}

// The peer of the other host has more than each of the ports.
TEST_F(Fragments, AHostWithManyPortsTakesNothingFromOthers) {
  const Bytes message = MessageOfSize(100 * 1024);
  const std::vector<Bytes> datagrams = Split(message, 1);
  ASSERT_EQ(Push(datagrams[0]), FragmentStatus::kPending);
  const Bytes flood = Split(MessageOfSize(16 * 1024), 1).front();
  for (std::uint64_t port = 0; port < 2 * 512; ++port) {
    ASSERT_EQ(reassembler_.Push({.host = 2, .peer = 10 + port}, flood, 100, message_),
              FragmentStatus::kPending);
    ASSERT_LE(reassembler_.pending_bytes(), ReassemblyLimits().max_total_bytes);
  }
  EXPECT_GT(reassembler_.pending_bytes(), ReassemblyLimits().max_total_bytes * 9 / 10);
  for (std::size_t i = 1; i + 1 < datagrams.size(); ++i) (void)Push(datagrams[i], 1, 200);
  EXPECT_EQ(Push(datagrams.back(), 1, 200), FragmentStatus::kComplete);
  EXPECT_EQ(Bytes(message_.begin(), message_.end()), message);
}

TEST_F(Fragments, OfAHostThePeerWithTheMostGives) {
  const std::vector<Bytes> datagrams = Split(MessageOfSize(8 * 1024), 1);
  ASSERT_EQ(reassembler_.Push({.host = 2, .peer = 1}, datagrams[0], 0, message_),
            FragmentStatus::kPending);
  const Bytes flood = Split(MessageOfSize(16 * 1024), 1).front();
  for (std::uint64_t port = 0; port < 2 * 512; ++port) {
    (void)reassembler_.Push({.host = 2, .peer = 10 + port}, flood, 100, message_);
  }
  FragmentStatus status = FragmentStatus::kPending;
  for (std::size_t i = 1; i < datagrams.size(); ++i) {
    status = reassembler_.Push({.host = 2, .peer = 1}, datagrams[i], 200, message_);
  }
  EXPECT_EQ(status, FragmentStatus::kComplete);
}

TEST_F(Fragments, LackOfMemoryLeavesEverythingAsItWas) {
  const std::vector<Bytes> datagrams = Split(LargeMessage(), 1);
  ASSERT_EQ(Push(datagrams[0], 2), FragmentStatus::kPending);
  const std::size_t before = reassembler_.pending_bytes();
  std::uint64_t allowed = 0;
  for (bool failed = true; failed; ++allowed) {
    try {
      const furrow::test::AllocationLimit limit(allowed);
      (void)Push(datagrams[0]);
      failed = false;
    } catch (const std::bad_alloc&) {
      ASSERT_EQ(reassembler_.pending_bytes(), before) << allowed;
      ASSERT_EQ(reassembler_.pending_messages(), 1u) << allowed;
    }
  }
  EXPECT_GT(allowed, 5u);
  for (std::size_t i = 1; i + 1 < datagrams.size(); ++i) (void)Push(datagrams[i]);
  EXPECT_EQ(Push(datagrams.back()), FragmentStatus::kComplete);
  reassembler_.ForgetPeer({.host = 2, .peer = 2});
  EXPECT_EQ(reassembler_.pending_bytes(), 0u);
}

// 40 subjects of one sender, two fragments a pose, 60 poses per second, 10% loss and up to 50 ms of
// jitter. Poses of one subject must not drop the fragments of another.
TEST_F(Fragments, ManyStreamsOfOnePeerDoNotDropEachOther) {
  constexpr int kSubjects = 40;
  constexpr int kPoses = 300;
  ASSERT_EQ(NumDatagrams(MediumMessage(0, 0).size()), 2u);
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> jitter_us(0, 50'000);
  std::bernoulli_distribution lost(0.1);
  std::multimap<std::int64_t, Bytes> arrivals;
  std::size_t whole = 0;
  for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
    for (std::uint16_t stream = 0; stream < kSubjects; ++stream) {
      const std::int64_t sent_us = pose * 16'667 + stream * 400;
      bool complete = true;
      for (const Bytes& fragment : Split(MediumMessage(stream, pose), pose * kSubjects + stream)) {
        if (lost(random)) {
          complete = false;
        } else {
          arrivals.emplace(sent_us + jitter_us(random), fragment);
        }
      }
      if (complete) ++whole;
    }
  }
  std::size_t received = 0;
  for (const auto& [at_us, fragment] : arrivals) {
    if (Push(fragment, 1, at_us) == FragmentStatus::kComplete) ++received;
    ASSERT_LE(reassembler_.pending_bytes(), ReassemblyLimits{}.max_peer_bytes);
  }
  EXPECT_EQ(received, whole);
}

TEST(ReassemblerLimits, RejectsAMessageAboveTheTotal) {
  Reassembler small({.max_total_bytes = 2000});
  std::span<const std::uint8_t> message;
  EXPECT_EQ(small.Push({}, Split(LargeMessage(), 1).front(), 0, message),
            FragmentStatus::kOverLimit);
  EXPECT_EQ(small.pending_bytes(), 0u);
}

TEST_F(Fragments, OldMessagesExpire) {
  const std::vector<Bytes> datagrams = Split(LargeMessage(), 1);
  (void)Push(datagrams[0], 1, 0);
  (void)Push(datagrams[0], 2, 400'000);
  EXPECT_EQ(reassembler_.Expire(500'000), 0u);
  EXPECT_EQ(reassembler_.Expire(500'001), 1u);
  EXPECT_EQ(reassembler_.pending_messages(), 1u);
}

}  // namespace
}  // namespace furrow::protocol
