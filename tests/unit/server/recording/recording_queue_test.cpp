// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recording_queue.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using recording::TakeKind;
using std::chrono::milliseconds;

RecordingBatch::Entry EntryOf(TakeKind kind, std::uint32_t sequence = 0) {
  RecordingBatch::Entry entry;
  entry.kind = kind;
  entry.stamp.sequence = sequence;
  return entry;
}

TEST(RecordingQueue, KeepsTheOrderAndTheBytes) {
  RecordingQueue queue(1000);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::vector<std::uint8_t> payload(i, static_cast<std::uint8_t>(i));
    ASSERT_TRUE(queue.Push(EntryOf(TakeKind::kPose, i), i % 2 ? "bob" : "ada", payload));
  }
  RecordingBatch batch;
  EXPECT_TRUE(queue.Take(&batch, milliseconds(0)));
  std::uint32_t next = 0;
  batch.ForEach([&](const RecordingBatch::Entry& entry, std::string_view subject,
                    std::span<const std::uint8_t> payload) {
    EXPECT_EQ(entry.stamp.sequence, next);
    EXPECT_EQ(subject, next % 2 ? "bob" : "ada");
    EXPECT_EQ(payload.size(), next);
    for (const std::uint8_t byte : payload) EXPECT_EQ(byte, next);
    ++next;
    return true;
  });
  EXPECT_EQ(next, 5u);
  EXPECT_TRUE(queue.Take(&batch, milliseconds(0)));
  EXPECT_EQ(batch.size(), 0u) << "each is taken once";
}

TEST(RecordingQueue, AFullQueueRefusesPosesBeforeDeclarations) {
  RecordingQueue queue(100);
  const std::vector<std::uint8_t> payload(90);
  EXPECT_TRUE(queue.Push(EntryOf(TakeKind::kPose), "ada", payload));
  EXPECT_FALSE(queue.Push(EntryOf(TakeKind::kPose), "ada", payload));
  EXPECT_FALSE(queue.Push(EntryOf(TakeKind::kWeights), "ada", payload));
  EXPECT_TRUE(queue.Push(EntryOf(TakeKind::kSkeleton), "ada", payload));
  EXPECT_FALSE(queue.Push(EntryOf(TakeKind::kNames), "ada", payload)) << "those are bounded, too";
  RecordingBatch batch;
  ASSERT_TRUE(queue.Take(&batch, milliseconds(0)));
  EXPECT_EQ(batch.size(), 2u);
  EXPECT_TRUE(queue.Push(EntryOf(TakeKind::kPose), "ada", payload)) << "there is room again";
}

TEST(RecordingQueue, AStoppedQueueReturnsTheRestAndAcceptsNothing) {
  RecordingQueue queue(100);
  EXPECT_TRUE(queue.Push(EntryOf(TakeKind::kPose), "ada", {}));
  queue.Stop();
  EXPECT_FALSE(queue.Push(EntryOf(TakeKind::kPose), "ada", {}));
  RecordingBatch batch;
  EXPECT_FALSE(queue.Take(&batch, std::chrono::hours(1))) << "at once, and the last";
  EXPECT_EQ(batch.size(), 1u);
}

}  // namespace
}  // namespace furrow::server
