// SPDX-License-Identifier: Apache-2.0
#include "base/time/timecode.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace furrow {
namespace {

std::string TextOf(std::int64_t frame, std::int64_t numerator, std::int64_t denominator) {
  const auto timecode = MakeTimecode(frame, 0.0, numerator, denominator);
  return timecode ? TimecodeText(*timecode) : "none";
}

struct Published {
  std::int64_t frame;
  const char* text;
};

// The numbers that are left out, and the frames beside them, as tables of ST 12-1 give them: 1,800
// frames in the first minute of ten, 1,798 in each of the others, 17,982 in ten, 107,892 per hour.
TEST(Timecode, DropFrameAt30FollowsThePublishedTables) {
  for (const auto& [frame, text] :
       {Published{0, "00:00:00;00"}, Published{29, "00:00:00;29"}, Published{30, "00:00:01;00"},
        Published{1799, "00:00:59;29"}, Published{1800, "00:01:00;02"},
        Published{3597, "00:01:59;29"}, Published{3598, "00:02:00;02"},
        Published{5396, "00:03:00;02"}, Published{16183, "00:08:59;29"},
        Published{16184, "00:09:00;02"}, Published{17981, "00:09:59;29"},
        Published{17982, "00:10:00;00"}, Published{19781, "00:10:59;29"},
        Published{19782, "00:11:00;02"}, Published{107891, "00:59:59;29"},
        Published{107892, "01:00:00;00"}, Published{2589407, "23:59:59;29"}}) {
    EXPECT_EQ(TextOf(frame, 30000, 1001), text) << frame;
  }
}

TEST(Timecode, DropFrameAt60LeavesOutFourNumbers) {
  for (const auto& [frame, text] :
       {Published{3599, "00:00:59;59"}, Published{3600, "00:01:00;04"},
        Published{35963, "00:09:59;59"}, Published{35964, "00:10:00;00"},
        Published{215784, "01:00:00;00"}, Published{5178815, "23:59:59;59"}}) {
    EXPECT_EQ(TextOf(frame, 60000, 1001), text) << frame;
  }
}

// Counts as a clock does: number by number, without those that ST 12-1 leaves out.
TEST(Timecode, DropFrameMatchesACounterForAWholeDay) {
  for (const std::uint32_t nominal : {30u, 60u}) {
    std::uint32_t frame = 0;
    for (std::uint32_t minute = 0; minute < 24 * 60; ++minute) {
      for (std::uint32_t i = 0; i < 60 * nominal; ++i) {
        if (minute % 10 != 0 && i < nominal / 15) continue;
        // Around the ends of minutes; everything between counts by one.
        if (i < 6 || i >= 60 * nominal - 2) {
          char text[32];
          std::snprintf(text, sizeof text, "%02u:%02u:%02u;%02u", minute / 60, minute % 60,
                        i / nominal, i % nominal);
          ASSERT_EQ(TextOf(frame, nominal * 1000, 1001), text);
        }
        ++frame;
      }
    }
    EXPECT_EQ(frame, TimecodeFramesPerDay({.rate_numerator = nominal * 1000,
                                           .rate_denominator = 1001,
                                           .drop_frame = true}));
  }
}

TEST(Timecode, OtherRatesCountEveryNumber) {
  EXPECT_EQ(TextOf(1'234'567, 60, 1), "05:42:56:07");
  EXPECT_EQ(TextOf(25 * 3600 * 10 + 24, 25, 1), "10:00:00:24");
  EXPECT_EQ(TextOf(86'400, 24000, 1001), "01:00:00:00") << "24 numbers per second, not drop-frame";
  EXPECT_EQ(TextOf(120 * 60 + 119, 120, 1), "00:01:00:119") << "three digits above 100";
  EXPECT_EQ(TimecodeText({.frame = 1800, .rate_numerator = 30000, .rate_denominator = 1001}),
            "00:01:00:00")
      << "29.97 without drop-frame";
}

TEST(Timecode, RatesAreWholeOrUpTo02PercentSlower) {
  EXPECT_EQ(NominalTimecodeRate(30, 1), 30);
  EXPECT_EQ(NominalTimecodeRate(30000, 1001), 30);
  EXPECT_EQ(NominalTimecodeRate(2997, 100), 30);
  EXPECT_EQ(NominalTimecodeRate(23976, 1000), 24);
  EXPECT_EQ(NominalTimecodeRate(1, 1), 1);
  EXPECT_EQ(NominalTimecodeRate(240, 1), 240);
  for (const auto& [numerator, denominator] :
       {std::pair{0u, 1u}, {30u, 0u}, {25u, 2u}, {241u, 1u}, {24000u, 1u}, {1u, 2u}, {299u, 10u}}) {
    EXPECT_EQ(NominalTimecodeRate(numerator, denominator), 0) << numerator << "/" << denominator;
  }
  EXPECT_TRUE(HasDropFrame(30000, 1001));
  EXPECT_TRUE(HasDropFrame(5994, 100));
  EXPECT_TRUE(HasDropFrame(2999, 100)) << "as protocol/STANDARD.md";
  EXPECT_FALSE(HasDropFrame(30, 1));
  EXPECT_FALSE(HasDropFrame(24000, 1001));
}

TEST(Timecode, StartsAgainAtMidnight) {
  EXPECT_EQ(TextOf(60 * 86400 - 1, 60, 1), "23:59:59:59");
  EXPECT_EQ(TextOf(60 * 86400, 60, 1), "00:00:00:00");
  EXPECT_EQ(TextOf(60 * 86400 + 61, 60, 1), "00:00:01:01") << "a count that runs on";
  EXPECT_EQ(TextOf(2'589'408, 30000, 1001), "00:00:00;00");
  EXPECT_EQ(TextOf(60 * 86400 * 2, 60, 1), "none") << "no time of day";
}

TEST(Timecode, HostileNumbersAreNoTimecode) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(MakeTimecode(-1, 0.0, 30, 1));
  EXPECT_FALSE(MakeTimecode(kMost, 0.0, 30, 1));
  EXPECT_FALSE(MakeTimecode(kLeast, 0.0, 30, 1));
  EXPECT_FALSE(MakeTimecode(0, NAN, 30, 1));
  EXPECT_FALSE(MakeTimecode(0, INFINITY, 30, 1));
  EXPECT_FALSE(MakeTimecode(0, 0.0, 0, 1));
  EXPECT_FALSE(MakeTimecode(0, 0.0, 30, 0));
  EXPECT_FALSE(MakeTimecode(0, 0.0, -30, -1));
  EXPECT_FALSE(MakeTimecode(0, 0.0, kMost, 1));
  EXPECT_FALSE(MakeTimecode(0, 0.0, kMost, kMost - 1));
  EXPECT_FALSE(MakeTimecode(0, 0.0, kLeast, kLeast));
  EXPECT_EQ(MakeTimecode(0, 0.0, kMost, kMost)->rate_numerator, 1u) << "reduced";
  EXPECT_EQ(MakeTimecode(0, -7.0, 30, 1)->subframe, 0);
  EXPECT_EQ(MakeTimecode(0, 1e300, 30, 1)->subframe, 255);
  EXPECT_FALSE(IsValid({.frame = 30 * 86400}));
  EXPECT_FALSE(IsValid({.rate_denominator = 0}));
  EXPECT_FALSE(IsValid({.rate_numerator = 0xFFFFFFFF, .rate_denominator = 1}));
  EXPECT_FALSE(IsValid({.rate_numerator = 25, .drop_frame = true}));
  EXPECT_TRUE(IsValid({.frame = 30 * 86400 - 1}));
}

TEST(Timecode, KeepsPartsOfAFrame) {
  EXPECT_EQ(MakeTimecode(7, 0.25, 60, 1)->subframe, 64);
  EXPECT_EQ(MakeTimecode(7, 0.999, 60, 1)->subframe, 255);
  EXPECT_EQ(MakeTimecode(7, 0.25, 60000, 1001),
            (Timecode{7, 60000, 1001, 64, /*drop_frame=*/true}));
}

TEST(Timecode, TextReadsBack) {
  for (const auto& [numerator, denominator] :
       {std::pair<std::uint32_t, std::uint16_t>{30'000, 1001},
        {60'000, 1001},
        {25, 1},
        {240, 1},
        {24'000, 1001}}) {
    const std::uint32_t day = TimecodeFramesPerDay(*MakeTimecode(0, 0.0, numerator, denominator));
    for (std::uint32_t frame = 0; frame < day; frame += frame < 40'000 ? 1 : 9973) {
      const Timecode timecode = *MakeTimecode(frame, 0.0, numerator, denominator);
      ASSERT_EQ(ParseTimecode(TimecodeText(timecode), numerator, denominator), timecode) << frame;
    }
  }
}

TEST(Timecode, ReadsTheTextsOfApps) {
  EXPECT_EQ(ParseTimecode("05:42:56:07.250", 60), (Timecode{1'234'567, 60, 1, 64, false}));
  EXPECT_EQ(ParseTimecode("00:10:00;00", 30), (Timecode{17'982, 30'000, 1001, 0, true}));
  EXPECT_EQ(ParseTimecode("00:01:00:00", 30'000, 1001), (Timecode{1800, 30'000, 1001, 0, false}))
      << "29.97 without drop-frame";
  for (const char* bad : {"",
                          "00:00:00",
                          "00:00:00:30",
                          "24:00:00:00",
                          "00:60:00:00",
                          "00:00:60:00",
                          "00:01:00;00",
                          "00:01:00;01",
                          "-1:00:00:00",
                          "00:00:00:-0",
                          "00:00:0.5:00",
                          "a:b:c:d",
                          "00:00:00:nan",
                          "00:00:00:00:00",
                          "1e9:00:00:00",
                          ":::",
                          "1e1:00:00:00",
                          "+1:00:00:00",
                          "1.0:0:0:0",
                          "00;00;00:00",
                          "00;00:00;00",
                          "00:00;00:00",
                          "00:00:00:1e1",
                          "00:00:00:+1",
                          "00:00:00:.5",
                          "00:00:00:1.",
                          "00:00:00:1.-5",
                          "00:00:00:1.2.3",
                          "00:00:00: 1",
                          "99999999999:00:00:00",
                          "00:00:00:99999999999999999999",
                          ";",
                          ":00:00:00"}) {
    EXPECT_FALSE(ParseTimecode(bad, 30)) << bad;
  }
  EXPECT_FALSE(ParseTimecode("00:00:00;00", 25)) << "no drop-frame at this rate";
  EXPECT_FALSE(ParseTimecode("00:00:00:00", 0));
  EXPECT_FALSE(ParseTimecode("00:00:00:00", 30, 0));
}

TEST(Timecode, FieldsNeedNoRate) {
  EXPECT_EQ(ParseTimecodeFields("05:42:56:07.250"), (TimecodeFields{20'576, 7.25, false}));
  EXPECT_EQ(ParseTimecodeFields("23:59:59;239"), (TimecodeFields{86'399, 239.0, true}));
  EXPECT_EQ(ParseTimecodeFields("1:2:3:4"), (TimecodeFields{3723, 4.0, false})) << "no zeros";
  EXPECT_FALSE(ParseTimecodeFields("00:00:00:240")) << "above all rates";
  EXPECT_EQ(MakeTimecode(TimecodeFields{60, 2.5, true}, 60),  // the first 4 numbers are left out
            std::nullopt);
  EXPECT_EQ(MakeTimecode(TimecodeFields{60, 2.5, true}, 30),
            (Timecode{1800, 30'000, 1001, 128, true}));
  EXPECT_FALSE(MakeTimecode(TimecodeFields{-1, 0.0, false}, 30));
  EXPECT_FALSE(MakeTimecode(TimecodeFields{0, -1.0, false}, 30));
  EXPECT_FALSE(MakeTimecode(TimecodeFields{0, NAN, false}, 30));
  EXPECT_FALSE(MakeTimecode(TimecodeFields{86'400, 0.0, false}, 30));
}

}  // namespace
}  // namespace furrow
