// SPDX-License-Identifier: Apache-2.0
#include "recording/take_reader.h"

#include <algorithm>

#include "protocol/messages/limits.h"
#include "recording/take_poses.h"
#include "recording/take_summary.h"
#include "tests/unit/recording/take_testing.h"

namespace furrow::recording {
namespace {

class TakeReaderTest : public TakeTest {};

TEST_F(TakeReaderTest, MessagesBeyondTheWiresLimitAreUnreadable) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 2);
  auto longest = Payload(Pose(0.5f));
  longest.resize(protocol::kMaxRequestBytes);  // padding that no field refers to
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(2), longest).ok());
  longest.push_back(0);
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(3), longest).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto take = Open("take.mcap");
  const auto summary = Summarise(*take);
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->messages, 5u);
  EXPECT_EQ(summary->subjects.at("ada").poses, 3u);
  EXPECT_EQ(summary->subjects.at("ada").unreadable, 1u);
  motion::ClipReport report;
  const auto poses = TakePoses::Load(*take, "ada", &report);
  ASSERT_TRUE(poses.ok()) << poses.status().ToString();
  EXPECT_EQ(poses->size(), 3u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("skipped 1 unreadable message of 'ada'"), std::string::npos);
}

TEST_F(TakeReaderTest, ReadsTheLargestListOfNames) {
  protocol::SubscribeReply reply{.subject = "ada", .names_hash = 0, .names = {}};
  for (int i = 0; i < protocol::kMaxWeights; ++i) {
    std::string name = std::to_string(i);
    reply.names.push_back(name + std::string(protocol::kMaxNameBytes - name.size(), 'x'));
  }
  const auto payload = Payload(reply);
  ASSERT_GT(payload.size(), protocol::kMaxRequestBytes) << "larger than any message of a publisher";
  const auto writer = Create("take.mcap");
  ASSERT_TRUE(writer->Write(TakeKind::kNames, "ada", Stamp(0), payload).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto summary = Summarise(*Open("take.mcap"));
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->subjects.at("ada").unreadable, 0u);
  EXPECT_EQ(summary->subjects.at("ada").weight_names, std::size_t{protocol::kMaxWeights});
}

TEST_F(TakeReaderTest, ReportsProgressAndAlwaysItsEnd) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 50);
  ASSERT_TRUE(writer->Close().ok());
  const auto take = Open("take.mcap");
  std::vector<std::uint64_t> reported;
  std::uint64_t last_total = 0;
  take->set_progress([&](std::uint64_t done, std::uint64_t total) {
    reported.push_back(done);
    last_total = total;
  });
  ASSERT_TRUE(take->ForEach([](const TakeMessage&) { return true; }).ok());
  ASSERT_EQ(reported.size(), 52u) << "a skeleton, 50 poses, the end";
  EXPECT_TRUE(std::ranges::is_sorted(reported));
  EXPECT_LT(reported[50], last_total);
  EXPECT_GT(reported[50], last_total / 2);
  EXPECT_EQ(reported[51], last_total);

  reported.clear();
  ASSERT_TRUE(take->ForEach([](const TakeMessage&) { return false; }).ok());
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_EQ(reported[1], last_total) << "a progress bar must end";
}

}  // namespace
}  // namespace furrow::recording
