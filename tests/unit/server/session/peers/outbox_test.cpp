// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/outbox.h"

#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/session/peers/peer.h"

namespace furrow::server {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::ElementsAre;

std::vector<int> PopAll(Outbox* outbox) {
  std::vector<int> first_bytes;
  Bytes bytes;
  while (outbox->Pop(&bytes)) first_bytes.push_back(bytes.at(0));
  return first_bytes;
}

TEST(Outbox, RepliesGoFirstAndInOrder) {
  Outbox outbox(4, 4);
  outbox.PushFrame(1, Bytes{10});
  ASSERT_TRUE(outbox.PushReply(Bytes{1}));
  ASSERT_TRUE(outbox.PushReply(Bytes{2}));
  EXPECT_THAT(PopAll(&outbox), ElementsAre(1, 2, 10));
  EXPECT_TRUE(outbox.empty());
}

TEST(Outbox, CountsWhatWaits) {
  Outbox outbox(4, 4);
  EXPECT_EQ(outbox.bytes(), 0u);
  outbox.PushFrame(1, Bytes(10));
  ASSERT_TRUE(outbox.PushReply(Bytes(100)));
  EXPECT_FALSE(outbox.owes_frames());
  outbox.PushFrame(2, Bytes(1000), kKeepAll);
  EXPECT_EQ(outbox.bytes(), 1110u);
  EXPECT_TRUE(outbox.owes_frames());
  Bytes bytes;
  while (outbox.Pop(&bytes)) EXPECT_EQ(outbox.owes_frames(), bytes.size() == 100);
  EXPECT_EQ(outbox.bytes(), 0u);
}

TEST(Outbox, FramesAreAlsoBoundedInBytes) {
  Outbox outbox(4, 100, 1000, 1000);
  const std::vector<std::uint8_t> half(500, 1);
  const std::vector<std::uint8_t> small(10, 2);
  const std::vector<std::uint8_t> large(5000, 3);
  EXPECT_EQ(outbox.PushFrame(1, half), 0);
  EXPECT_EQ(outbox.PushFrame(2, half), 0);
  EXPECT_EQ(outbox.PushFrame(3, small), 1) << "the oldest makes room";
  EXPECT_EQ(outbox.PushFrame(4, large), 2) << "one always fits";
  EXPECT_EQ(outbox.num_frames(), 1u);
  std::vector<std::uint8_t> out;
  ASSERT_TRUE(outbox.Pop(&out));
  EXPECT_EQ(out, large);
  // A frame that grows in its place keeps it, and the others make room.
  EXPECT_EQ(outbox.PushFrame(1, small), 0);
  EXPECT_EQ(outbox.PushFrame(2, half), 0);
  EXPECT_EQ(outbox.PushFrame(1, large), 2);
  ASSERT_TRUE(outbox.Pop(&out));
  EXPECT_EQ(out, large);
  EXPECT_TRUE(outbox.empty());
  // What has left counts no more.
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(outbox.PushFrame(7, half), 0);
    outbox.DropFrames(7);
  }
  EXPECT_EQ(outbox.PushFrame(1, half), 0);
  EXPECT_EQ(outbox.PushFrame(2, half), 0);
}

TEST(Outbox, RepliesAreAlsoBoundedInBytes) {
  Outbox outbox(100, 4, 1000);
  EXPECT_TRUE(outbox.PushReply(Bytes(2000))) << "one alone may always wait";
  EXPECT_FALSE(outbox.PushReply(Bytes(1)));
  Bytes bytes;
  ASSERT_TRUE(outbox.Pop(&bytes));
  EXPECT_TRUE(outbox.PushReply(Bytes(600)));
  EXPECT_TRUE(outbox.PushReply(Bytes(400)));
  EXPECT_FALSE(outbox.PushReply(Bytes(1)));
}

class SharedOutbox : public testing::Test {
 protected:
  static constexpr std::size_t kChunk = WaitingBytes::kChunk;
  void SetUp() override { outbox.SetAccount({&budget, "host"}); }

  Metrics metrics;
  WaitingBytes budget{4 * kChunk, &metrics};
  Outbox outbox{4, 8};
};

// Fills the share of the host: what is free, and half of the budget.
TEST_F(SharedOutbox, WithoutRoomLargeMessagesAreDroppedAndSmallOnesAreNot) {
  EXPECT_EQ(outbox.PushFrame(1, Bytes(3 * kChunk, 1), kKeepAll), 0);
  EXPECT_EQ(budget.taken(), 2 * kChunk);
  EXPECT_EQ(outbox.PushFrame(1, Bytes{9}, kKeepAll), Link::kNoRoom) << "there is no end of them";
  EXPECT_EQ(outbox.PushFrame(2, Bytes(Outbox::kSmallFrame + 1, 9)), Link::kNoRoom);
  EXPECT_EQ(metrics.Get(Counter::kWaitingRefused), 2u);
  EXPECT_EQ(outbox.PushFrame(2, Bytes(Outbox::kSmallFrame, 3)), 0);
  EXPECT_TRUE(outbox.PushReply(Bytes(Outbox::kFreeReplies, 2)));
  EXPECT_FALSE(outbox.PushReply(Bytes{9})) << "close the peer";
  EXPECT_EQ(metrics.Get(Counter::kWaitingRefused), 3u);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(1, 2, 3));
  EXPECT_EQ(budget.taken(), 0u);
}

// Somebody else of the host reads nothing.
TEST_F(SharedOutbox, AClientThatReadsGetsItsReplies) {
  WaitingBytes::Account other(&budget, "host");
  ASSERT_TRUE(other.Hold(3 * kChunk));
  EXPECT_TRUE(outbox.PushReply(Bytes(20 * kChunk, 1))) << "no other one waits";
  Bytes bytes;
  ASSERT_TRUE(outbox.Pop(&bytes));
  EXPECT_FALSE(outbox.Pop(&bytes));
  EXPECT_TRUE(outbox.PushReply(Bytes(20 * kChunk, 1)));
}

TEST_F(SharedOutbox, ANewFrameReplacesThoseOfItsKeyAndNoOthers) {
  EXPECT_EQ(outbox.PushFrame(1, Bytes(kChunk, 1), 2), 0);
  EXPECT_EQ(outbox.PushFrame(2, Bytes(kChunk, 2), 2), 0);
  EXPECT_EQ(outbox.PushFrame(1, Bytes(kChunk, 3), 2), 0);
  EXPECT_EQ(budget.taken(), 2 * kChunk);
  EXPECT_EQ(outbox.PushFrame(1, Bytes(2 * kChunk, 4), 2), 2) << "both older ones";
  EXPECT_EQ(outbox.PushFrame(2, Bytes(2 * kChunk, 5), 2), Link::kNoRoom);
  EXPECT_EQ(outbox.PushFrame(3, Bytes{6}), 0) << "small";
  EXPECT_THAT(PopAll(&outbox), ElementsAre(2, 4, 6));
  EXPECT_EQ(budget.taken(), 0u);
  EXPECT_EQ(outbox.PushFrame(1, Bytes(4 * kChunk, 7)), Link::kNoRoom) << "more than the share";
}

TEST_F(SharedOutbox, WhatIsBeingSentStillCounts) {
  EXPECT_EQ(outbox.PushFrame(1, Bytes(3 * kChunk, 1)), 0);
  Bytes sent;
  ASSERT_TRUE(outbox.Pop(&sent));
  EXPECT_EQ(budget.taken(), 2 * kChunk);
  EXPECT_EQ(outbox.PushFrame(1, Bytes(kChunk, 2)), Link::kNoRoom);
  EXPECT_EQ(outbox.PushFrame(1, Bytes{2}), 0) << "small";
  ASSERT_TRUE(outbox.Pop(&sent));
  EXPECT_FALSE(outbox.Pop(&sent)) << "all has been sent";
  EXPECT_EQ(budget.taken(), 0u);
  EXPECT_EQ(outbox.PushFrame(1, Bytes(kChunk, 2)), 0);
}

TEST_F(SharedOutbox, WhatIsDroppedGivesRoom) {
  EXPECT_EQ(outbox.PushFrame(1, Bytes(3 * kChunk, 1)), 0);
  EXPECT_EQ(budget.taken(), 2 * kChunk);
  EXPECT_EQ(outbox.PushFrame(1, Bytes(2 * kChunk, 2)), 1) << "it replaces the first one";
  EXPECT_EQ(budget.taken(), kChunk);
  outbox.DropReplaceableFrames();
  EXPECT_EQ(budget.taken(), 0u);
  EXPECT_EQ(outbox.PushFrame(2, Bytes(2 * kChunk, 3), kKeepAll), 0);
  EXPECT_EQ(budget.taken(), kChunk);
  outbox.DropFrames(2);
  EXPECT_EQ(budget.taken(), 0u);
}

// Whatever is pushed and popped, the account ends at 0 and never exceeds the share.
TEST_F(SharedOutbox, TheAccountFollowsTheQueue) {
  std::mt19937 random(3);
  Bytes bytes;
  for (int step = 0; step < 20'000; ++step) {
    const Bytes message(random() % (2 * kChunk));
    switch (random() % 6) {
      case 0: (void)outbox.PushReply(message); break;
      case 1: (void)outbox.PushFrame(random() % 3, message, kKeepAll); break;
      case 2: outbox.DropFrames(random() % 3); break;
      case 3: (void)outbox.Pop(&bytes); break;
      default: (void)outbox.PushFrame(random() % 3, message, 1 + random() % 2);
    }
    ASSERT_LE(budget.taken(), 2 * kChunk);
  }
  while (outbox.Pop(&bytes)) {
  }
  EXPECT_EQ(budget.taken(), 0u);
  EXPECT_EQ(outbox.bytes(), 0u);
}

TEST(Outbox, TheNewestFrameOfAKeyWinsAndKeepsItsPlace) {
  Outbox outbox(4, 4);
  EXPECT_EQ(outbox.PushFrame(1, Bytes{10}), 0);
  EXPECT_EQ(outbox.PushFrame(2, Bytes{20}), 0);
  EXPECT_EQ(outbox.PushFrame(1, Bytes{11, 12, 13}), 1);
  EXPECT_EQ(outbox.num_frames(), 2u);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(11, 20));
}

TEST(Outbox, ABurstOfOneKeyWaitsUpToItsLimit) {
  Outbox outbox(4, 8);
  for (std::uint8_t i = 0; i < 4; ++i) EXPECT_EQ(outbox.PushFrame(1, Bytes{i}, 4), 0);
  EXPECT_EQ(outbox.PushFrame(2, Bytes{20}, 4), 0);
  EXPECT_EQ(outbox.PushFrame(1, Bytes{4}, 4), 1);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(1, 2, 3, 20, 4));
}

TEST(Outbox, TheOldestFrameIsDroppedAtTheFrameLimit) {
  Outbox outbox(4, 3);
  for (std::uint8_t key = 0; key < 3; ++key) EXPECT_EQ(outbox.PushFrame(key, Bytes{key}), 0);
  for (std::uint8_t key = 3; key < 10; ++key) EXPECT_EQ(outbox.PushFrame(key, Bytes{key}), 1);
  EXPECT_EQ(outbox.num_frames(), 3u);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(7, 8, 9));
}

TEST(Outbox, AFullQueueRefusesReplies) {
  Outbox outbox(2, 1);
  EXPECT_TRUE(outbox.PushReply(Bytes{1}));
  EXPECT_TRUE(outbox.PushReply(Bytes{2}));
  EXPECT_FALSE(outbox.PushReply(Bytes{3}));
  outbox.PushFrame(1, Bytes{9});
  EXPECT_THAT(PopAll(&outbox), ElementsAre(1, 2, 9));
}

TEST(Outbox, DroppingAKeyRemovesAllItsFrames) {
  Outbox outbox(2, 4);
  outbox.PushFrame(1, Bytes{1});
  outbox.PushFrame(2, Bytes{2});
  outbox.DropFrames(1);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(2));
}

TEST(Outbox, KeepAllFramesQueueWithTheReplies) {
  Outbox outbox(4, 4);
  outbox.PushFrame(1, Bytes{10});
  outbox.PushFrame(2, Bytes{20}, kKeepAll);
  ASSERT_TRUE(outbox.PushReply(Bytes{1}));
  for (std::uint8_t i = 21; i < 30; ++i) EXPECT_EQ(outbox.PushFrame(2, Bytes{i}, kKeepAll), 0);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(20, 1, 21, 22, 23, 24, 25, 26, 27, 28, 29, 10));
}

TEST(Outbox, ALeavingPeerReceivesRepliesButNoReplaceableFrames) {
  Outbox outbox(4, 4);
  outbox.PushFrame(1, Bytes{10});
  outbox.PushFrame(2, Bytes{20}, kKeepAll);
  ASSERT_TRUE(outbox.PushReply(Bytes{1}));
  outbox.DropReplaceableFrames();
  EXPECT_EQ(outbox.num_frames(), 0u);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(20, 1));
  EXPECT_EQ(outbox.PushFrame(1, Bytes{11}), 0) << "the key has room again";
}

TEST(Outbox, KeepAllFramesAreBounded) {
  Outbox outbox(4, 4);
  const Bytes half(protocol::kMaxWaitingFrameBytes / 2, 1);
  EXPECT_EQ(outbox.PushFrame(1, half, kKeepAll), 0);
  EXPECT_EQ(outbox.PushFrame(1, half, kKeepAll), 0);
  EXPECT_EQ(outbox.PushFrame(1, Bytes{2}, kKeepAll), 1);
  EXPECT_TRUE(outbox.PushReply(Bytes{3})) << "replies have room of their own";
  Bytes bytes;
  ASSERT_TRUE(outbox.Pop(&bytes));
  EXPECT_EQ(outbox.PushFrame(1, Bytes{4}, kKeepAll), 0);
  outbox.DropFrames(1);
  EXPECT_THAT(PopAll(&outbox), ElementsAre(3)) << "the reply is not a frame";
  EXPECT_EQ(outbox.PushFrame(1, half, kKeepAll), 0);
  EXPECT_EQ(outbox.PushFrame(1, half, kKeepAll), 0) << "what was dropped makes room";
}

}  // namespace
}  // namespace furrow::server
