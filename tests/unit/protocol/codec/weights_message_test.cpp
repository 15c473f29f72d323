// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Encoded;
using test::OpenAndDecode;

TEST(WeightsMessage, RoundTrip) {
  WeightFrame sent{77, 1000, WeightFormat::kF32, {0.0f, 0.123456f, 1.0f}};
  WeightFrame out;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.names_hash, 77u);
  EXPECT_EQ(out.age_us, 1000);
  EXPECT_EQ(out.format, WeightFormat::kF32);
  EXPECT_EQ(out.values, sent.values);
  sent.format = WeightFormat::kU8;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.format, WeightFormat::kU8);
  ASSERT_EQ(out.values.size(), 3u);
  EXPECT_EQ(out.values[0], 0.0f);
  EXPECT_NEAR(out.values[1], 0.123456f, 1.0f / 510);
  EXPECT_EQ(out.values[2], 1.0f);
}

TEST(WeightsMessage, CarriesTheTimecodeOfThePose) {
  WeightFrame sent{77, 0, WeightFormat::kU8, {0.5f}};
  WeightFrame out;
  out.timecode = Timecode{};
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.timecode);
  sent.timecode = Timecode{1'234'567, 60, 1, 64, /*drop_frame=*/false};
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.timecode, sent.timecode);
  sent.timecode->rate_numerator = 0;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.timecode) << "invalid";
}

TEST(WeightsMessage, EmptyWeightsKeepTheirFormat) {
  WeightFrame out;
  ASSERT_EQ(OpenAndDecode(Encoded(WeightFrame{0, 0, WeightFormat::kU8, {}}), out),
            DecodeStatus::kOk);
  EXPECT_EQ(out.format, WeightFormat::kU8);
  EXPECT_TRUE(out.values.empty());
}

TEST(WeightsMessage, RejectsBadWeights) {
  const auto decoded = [](const WeightFrame& sent) {
    WeightFrame out;
    return OpenAndDecode(Encoded(sent), out);
  };
  EXPECT_EQ(decoded({0, 0, WeightFormat::kF32, {NAN}}), DecodeStatus::kNonFinite);
  EXPECT_EQ(decoded({0, 0, WeightFormat::kF32, {1.001f}}), DecodeStatus::kBadValue);
  EXPECT_EQ(decoded({0, 0, WeightFormat::kF32, {-0.001f}}), DecodeStatus::kBadValue);
  EXPECT_EQ(decoded({0, -1, WeightFormat::kF32, {0.5f}}), DecodeStatus::kBadValue);
  EXPECT_EQ(decoded({0, 0, WeightFormat::kU8, std::vector<float>(kMaxWeights + 1)}),
            DecodeStatus::kLimit);
}

}  // namespace
}  // namespace furrow::protocol
