// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/weight_writer.h"

#include <array>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::cli {
namespace {

const std::vector<std::string> kNames{"brow_l.squash", "knee_l_inner.folds"};
constexpr std::array<float, 2> kValues{0.25f, 1.0f};

std::string Write(TableFormat format) {
  ::testing::internal::CaptureStdout();
  const auto writer = WeightWriter::Create(format);
  writer->Names(kNames);
  EXPECT_TRUE(writer->Row(7, 1.5, kValues));
  return ::testing::internal::GetCapturedStdout();
}

TEST(WeightWriterTest, CsvHasTheDocumentedFormat) {
  EXPECT_EQ(Write(TableFormat::kCsv),
            "frame,time,brow_l.squash,knee_l_inner.folds\n7,1.500000,0.250000,1.000000\n");
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
