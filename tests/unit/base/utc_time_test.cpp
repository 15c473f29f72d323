// SPDX-License-Identifier: Apache-2.0
#include "base/utc_time.h"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(UtcTime, FormatsAndReadsBack) {
  EXPECT_EQ(FormatUtc(0), "1970-01-01T00:00:00Z");
  EXPECT_EQ(FormatUtc(951'782'399), "2000-02-28T23:59:59Z");
  EXPECT_EQ(FormatUtc(951'782'400), "2000-02-29T00:00:00Z");
  EXPECT_EQ(FormatUtc(~0ULL), "9999-12-31T23:59:59Z");
  for (std::uint64_t time = 1; time < 200'000'000'000; time = time * 7 + 13) {
    EXPECT_EQ(ParseUtc(FormatUtc(time)), time);
  }
}

TEST(UtcTime, RejectsOtherText) {
  for (const char* text :
       {"", "2026-05-14", "2026-05-14T09:30:00", "2026-05-14 09:30:00Z", "2026-05-14T09:30:00z",
        "2026-02-29T00:00:00Z", "2026-13-01T00:00:00Z", "2026-00-01T00:00:00Z",
        "2026-01-32T00:00:00Z", "2026-01-01T24:00:00Z", "2026-01-01T00:60:00Z",
        "2026-01-01T00:00:60Z", "1969-12-31T23:59:59Z", "2026-05-14T09:30:0 Z",
        "-026-05-14T09:30:00Z", "2026-05-14T09:30:00Z "}) {
    EXPECT_EQ(ParseUtc(text), std::nullopt) << text;
  }
}

TEST(UtcTime, ReadsDurations) {
  EXPECT_EQ(ParseDuration("1s"), 1u);
  EXPECT_EQ(ParseDuration("30m"), 1'800u);
  EXPECT_EQ(ParseDuration("8h"), 28'800u);
  EXPECT_EQ(ParseDuration("14d"), 1'209'600u);
  EXPECT_EQ(ParseDuration("36525d"), 36'525u * 86'400u);
  for (const char* text : {"", "h", "8", "0h", "-8h", "+8h", "8 h", "8H", "8hh", "1.5h", "36526d",
                           "18446744073709551615d", "99999999999999999999d", "1w"}) {
    EXPECT_EQ(ParseDuration(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace furrow
