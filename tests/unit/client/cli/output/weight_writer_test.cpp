// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/weight_writer.h"

#include <array>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::cli {
namespace {

const std::vector<std::string> kNames{"brow_l.squash", "knee_l_inner.folds"};
constexpr std::array<float, 2> kValues{0.25f, 1.0f};

// Of 30000/1001 frames per second, drop-frame.
constexpr Timecode kTenPastOne{
    .frame = 125874, .rate_numerator = 30000, .rate_denominator = 1001, .drop_frame = true};

std::string Write(TableFormat format, std::optional<Timecode> timecode = {},
                  bool timecodes = false) {
  ::testing::internal::CaptureStdout();
  const auto writer = WeightWriter::Create(format, timecodes);
  writer->Names(kNames);
  EXPECT_TRUE(writer->Row({7, 1.5, timecode}, kValues));
  return ::testing::internal::GetCapturedStdout();
}

TEST(WeightWriterTest, CsvHasTheDocumentedFormat) {
  EXPECT_EQ(Write(TableFormat::kCsv),
            "frame,time,brow_l.squash,knee_l_inner.folds\n7,1.500000,0.250000,1.000000\n");
}

TEST(WeightWriterTest, TimecodesAreShown) {
  EXPECT_EQ(Write(TableFormat::kCsv, kTenPastOne),
            "frame,time,brow_l.squash,knee_l_inner.folds\n7,1.500000,0.250000,1.000000\n");
  EXPECT_EQ(Write(TableFormat::kCsv, kTenPastOne, true),
            "frame,time,brow_l.squash,knee_l_inner.folds,timecode\n"
            "7,1.500000,0.250000,1.000000,01:10:00;00\n");
  EXPECT_EQ(Write(TableFormat::kCsv, {}, true),
            "frame,time,brow_l.squash,knee_l_inner.folds,timecode\n"
            "7,1.500000,0.250000,1.000000,\n");
  const auto row = nlohmann::json::parse(Write(TableFormat::kJsonl, kTenPastOne));
  EXPECT_EQ(row["timecode"], "01:10:00;00");
  EXPECT_EQ(Write(TableFormat::kTable, kTenPastOne).find("frame 7  1.500 s  01:10:00;00\n"), 0u);
}

TEST(WeightWriterTest, JsonLinesParse) {
  const auto row = nlohmann::json::parse(Write(TableFormat::kJsonl));
  EXPECT_EQ(row["frame"], 7);
  EXPECT_EQ(row["time"], 1.5);
  EXPECT_EQ(row["weights"]["brow_l.squash"], 0.25);
  EXPECT_EQ(row["weights"].size(), 2u);
}

TEST(WeightWriterTest, TableShowsTheLargestWeightsFirst) {
  const std::string text = Write(TableFormat::kTable);
  const std::size_t knee = text.find("knee_l_inner.folds");
  const std::size_t brow = text.find("brow_l.squash");
  ASSERT_NE(knee, std::string::npos);
  ASSERT_NE(brow, std::string::npos);
  EXPECT_LT(knee, brow);
}

}  // namespace
}  // namespace furrow::cli
