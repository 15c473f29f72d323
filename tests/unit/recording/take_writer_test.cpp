// SPDX-License-Identifier: Apache-2.0
#include "recording/take_writer.h"

#include <malloc.h>

#include "tests/unit/recording/take_testing.h"

namespace furrow::recording {
namespace {

class TakeWriterTest : public TakeTest {};

// A daemon that runs for weeks sees many short sessions, and keeps what it knows of each until the
// file ends: four channels of about 110 bytes, and the session's key.
TEST_F(TakeWriterTest, ASessionKeepsLessThanAKilobyte) {
  const std::size_t at_first = mallinfo2().uordblks;
  const std::vector<char> measured(1 << 16);
  if (mallinfo2().uordblks - at_first < measured.size() / 2) {
    GTEST_SKIP() << "this allocator does not count its memory";
  }
  auto take = TakeWriter::Create(folder_ / "take.mcap", "{}").value();
  const auto offer = Payload(Offer("ada"));
  const auto pose = Payload(Pose(0.5f));
  const auto write_session = [&](std::uint64_t session) {
    for (std::uint32_t i = 0; i < 20; ++i) {
      const TakeStamp stamp = Stamp(static_cast<std::uint32_t>(20 * session) + i, session);
      if (i == 0) {
        ASSERT_TRUE(take->Write(TakeKind::kSkeleton, "ada", stamp, offer).ok());
        ASSERT_TRUE(take->Write(TakeKind::kNames, "ada", stamp, pose).ok());
      }
      ASSERT_TRUE(take->Write(TakeKind::kPose, "ada", stamp, pose).ok());
      ASSERT_TRUE(take->Write(TakeKind::kWeights, "ada", stamp, pose).ok());
    }
  };
  constexpr std::uint64_t kWarmUp = 1000;  // the vectors' spare room is then the same
  constexpr std::uint64_t kSessions = 2000;
  for (std::uint64_t session = 1; session <= kWarmUp; ++session) write_session(session);
  const std::size_t before = mallinfo2().uordblks;
  for (std::uint64_t session = 1; session <= kSessions; ++session) write_session(kWarmUp + session);
  const std::size_t kept = mallinfo2().uordblks - before;
  EXPECT_LT(kept / kSessions, 1024u);
  EXPECT_GT(kept / kSessions, 100u) << "the sessions were not written";
  ASSERT_TRUE(take->Close().ok());
}

}  // namespace
}  // namespace furrow::recording
