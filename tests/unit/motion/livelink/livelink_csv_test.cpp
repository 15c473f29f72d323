// SPDX-License-Identifier: Apache-2.0
#include "motion/livelink/livelink_csv.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kHeader = "Timecode,BlendShapeCount,JawOpen,EyeBlinkLeft,HeadYaw\n";

Clip Parse(const std::string& text, const LoadOptions& options = {}, ClipReport* report = nullptr) {
  Result<Clip> clip = ParseLiveLinkCsv(text, "t.csv", options, report);
  EXPECT_TRUE(clip.ok()) << clip.status().ToString();
  return clip.ok() ? std::move(*clip) : Clip();
}

TEST(LiveLinkCsv, FindsColumnsByName) {
  const Clip clip = Parse(std::string(kHeader) + "14:03:22:59.500,3,0.25,1,-0.1\r\n" +
                          "14:03:23:00.500,3,0.5,0,0\r\n");
  EXPECT_THAT(clip.blend_shape_names, ElementsAre("JawOpen", "EyeBlinkLeft", "HeadYaw"));
  EXPECT_THAT(clip.blend_shapes, ElementsAre(0.25f, 1.0f, -0.1f, 0.5f, 0.0f, 0.0f));
  EXPECT_EQ(clip.skeleton.num_joints(), 0);
  ASSERT_EQ(clip.num_frames(), 2);
  EXPECT_EQ(clip.times[0], 0.0);
  EXPECT_NEAR(clip.times[1], 1.0 / 60.0, 1e-9);
  // The same recording with shuffled columns in another case.
  const Clip shuffled = Parse("HeadYaw,TIMECODE,JawOpen,blendshapecount\n1,00:00:00:00,2,2\n");
  EXPECT_THAT(shuffled.blend_shape_names, ElementsAre("HeadYaw", "JawOpen"));
  EXPECT_THAT(shuffled.blend_shapes, ElementsAre(1.0f, 2.0f));
}

TEST(LiveLinkCsv, InfersTheTimecodesRate) {
  for (const int rate : {24, 25, 30, 60, 120}) {
    std::string text = "Timecode,BlendShapeCount,JawOpen\n";
    for (int f = 0; f < 2 * rate; ++f) {
      text += "00:00:0" + std::to_string(f / rate) + ":" + std::to_string(f % rate) + ",1,0\n";
    }
    ClipReport report;
    const Clip clip = Parse(text, {}, &report);
    EXPECT_NEAR(clip.times.back(), (2.0 * rate - 1.0) / rate, 1e-9) << rate;
    EXPECT_THAT(report.warnings, SizeIs(0));
  }
  ClipReport report;
  const std::string brief = std::string(kHeader) + "00:00:00:00,3,0,0,0\n00:00:00:06,3,0,0,0\n";
  EXPECT_NEAR(Parse(brief, {}, &report).times[1], 0.1, 1e-9);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("too short")));
  EXPECT_NEAR(Parse(brief, {.timecode_rate = 30.0}).times[1], 0.2, 1e-9);
}

TEST(LiveLinkCsv, PassesMidnightAndSkipsRowsWithoutAFace) {
  ClipReport report;
  const Clip clip = Parse(std::string(kHeader) +
                              "23:59:59:59.000,3,0,0,0\n"
                              "00:00:00:00.000,3,1,0,0\n"
                              "00:00:00:01.000,0\n"
                              "00:00:00:02.000,0,,,\n"
                              "00:00:00:03.000,3,2,0,0\n"
                              "00:00:00:03.000,3,9,0,0\n",
                          {}, &report);
  ASSERT_EQ(clip.num_frames(), 3);
  EXPECT_NEAR(clip.times[1], 1.0 / 60.0, 1e-6);
  EXPECT_NEAR(clip.times[2], 4.0 / 60.0, 1e-6);
  EXPECT_EQ(clip.blend_shapes[6], 2.0f);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("2 rows without a face"),
                                           HasSubstr("1 row with a repeated timecode")));
}

TEST(LiveLinkCsv, NamesTheLineOfEveryError) {
  const std::string good = std::string(kHeader) + "00:00:01:00.000,3,0,0,0\n";
  const std::tuple<std::string, StatusCode, const char*> kCases[] = {
      {"", StatusCode::kParse, "t.csv:1"},
      {"a,b,c\n", StatusCode::kParse, "t.csv:1"},
      {"Timecode,BlendShapeCount\n", StatusCode::kParse, "t.csv:1"},
      {"Timecode,A,A\n", StatusCode::kParse, "t.csv:1"},
      {kHeader, StatusCode::kParse, "t.csv:2"},
      {good + "00:00:02:00.000,3,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "00:00:02:00.000,3,0,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "00:00:02:00.000,3,0,nan,0\n", StatusCode::kNonFinite, "t.csv:3"},
      {good + "00:00:02:00.000,3,0,,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "00:00:60:00.000,3,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "24:00:00:00.000,3,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "00:00:00:240,3,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "00:00:02,3,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "1.5:00:00:00,3,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "1e1:00:00:00,3,0,0,0\n", StatusCode::kParse, "t.csv:3"},
      {good + "00:01:00:00,3,0,0,0\n00:00:30:00,3,0,0,0\n", StatusCode::kParse, "t.csv:4"}};
  for (const auto& [text, code, where] : kCases) {
    const Result<Clip> clip = ParseLiveLinkCsv(text, "t.csv");
    ASSERT_FALSE(clip.ok()) << text;
    EXPECT_EQ(clip.status().code(), code) << text << clip.status().ToString();
    EXPECT_EQ(clip.status().where(), where) << text;
  }
  std::string wide = "Timecode";
  for (int i = 0; i < 3000; ++i) wide += ",c" + std::to_string(i);
  EXPECT_EQ(ParseLiveLinkCsv(wide, "t.csv").status().code(), StatusCode::kLimit);
  const Status long_row =
      ParseLiveLinkCsv(good + "00:00:02:00,3" + std::string(100'000, ','), "t.csv").status();
  EXPECT_THAT(long_row.ToString(),
              HasSubstr("t.csv:3: the row has 100002 cells, the header has 5"));
}

Clip MakeTake(double rate, int frames) {
  Clip clip;
  clip.blend_shape_names = {"JawOpen", "BrowInnerUp"};
  for (int f = 0; f < frames; ++f) {
    clip.times.push_back(f / rate);
    clip.blend_shapes.push_back(std::sin(0.1f * static_cast<float>(f)));
    clip.blend_shapes.push_back(1.0f / (1.0f + static_cast<float>(f)));
  }
  return clip;
}

TEST(LiveLinkCsv, RoundTripKeepsValuesExactlyAndTimesToAThousandthOfAFrame) {
  for (const double rate : {24.0, 30.0, 59.94, 60.0, 90.0, 120.0}) {
    const Clip take = MakeTake(rate, 400);
    const Result<std::string> text = LiveLinkCsvToText(take);
    ASSERT_TRUE(text.ok());
    const Clip read = Parse(*text);
    EXPECT_EQ(read.blend_shape_names, take.blend_shape_names);
    EXPECT_EQ(read.blend_shapes, take.blend_shapes);
    ASSERT_EQ(read.num_frames(), take.num_frames());
    for (std::size_t f = 0; f < take.times.size(); ++f) {
      EXPECT_NEAR(read.times[f], take.times[f], 0.001 / 24.0) << rate;
    }
  }
}

TEST(LiveLinkCsv, KeepsTheTimecodesOfTheFile) {
  const std::string rows =
      "14:03:22:58.000,3,0,0,0\n"
      "14:03:22:59.500,3,0.25,1,-0.1\n"
      "14:03:23:00.250,3,0.5,0,0\n";
  const Clip clip = Parse(kHeader + rows);
  ASSERT_THAT(clip.timecodes, SizeIs(3));
  EXPECT_EQ(clip.timecodes[1], ParseTimecode("14:03:22:59.500", 60));
  const Result<std::string> text = LiveLinkCsvToText(clip);
  ASSERT_TRUE(text.ok());
  EXPECT_THAT(*text, HasSubstr("\n14:03:22:59.500,3,0.25"));
  const Clip again = Parse(*text);
  EXPECT_EQ(again.timecodes, clip.timecodes);
  EXPECT_EQ(again.times, clip.times);
}

TEST(LiveLinkCsv, TimesOfDropFrameTimecodesHaveNoGaps) {
  std::string rows;
  for (const char* timecode : {"00:00:59;28", "00:00:59;29", "00:01:00;02", "00:01:00;03.500"}) {
    rows += std::string(timecode) + ",3,0,0,0\n";
  }
  const Clip clip = Parse(kHeader + rows);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(clip.times[i], static_cast<double>(i) * 1001 / 30'000, 1e-9);
  }
  EXPECT_NEAR(clip.times[3], 3.5 * 1001 / 30'000, 1e-9);
  EXPECT_EQ(clip.timecodes[2]->frame, 1800u);
  EXPECT_EQ(Parse(*LiveLinkCsvToText(clip)).timecodes, clip.timecodes);
  const Clip midnight = Parse(std::string(kHeader) + "23:59:59;29,3,0,0,0\n00:00:00;00,3,0,0,0\n",
                              {.timecode_rate = 30.0});
  EXPECT_NEAR(midnight.times[1], 1001.0 / 30'000, 1e-6);
}

// 4 of 5 rows, if rows in the gap counted otherwise than the others.
TEST(LiveLinkCsv, AnInvalidDropFrameTimecodeLosesNoRow) {
  std::string text = kHeader;
  for (const char* timecode :
       {"00:09:00;00", "00:09:00;01", "00:09:00;02", "00:09:00;29", "00:09:01;00"}) {
    text += std::string(timecode) + ",3,0,0,0\n";
  }
  ClipReport report;
  const Clip clip = Parse(text, {}, &report);
  ASSERT_EQ(clip.num_frames(), 5);
  EXPECT_THAT(report.warnings, SizeIs(0));
  EXPECT_NEAR(clip.times[2], 2.0 / 30.0, 1e-9);
  EXPECT_NEAR(clip.times[4], 1.0, 1e-9);
  EXPECT_FALSE(clip.timecodes[0]) << "left out";
  EXPECT_TRUE(clip.timecodes[2]);
}

TEST(LiveLinkCsv, RatesThatNoTimecodeHasGiveNone) {
  const std::string text = std::string(kHeader) + "00:00:10:00,3,0,0,0\n00:00:10:05,3,0,0,0\n";
  for (const double rate : {12.5, 29.5, 0.5, 300.0}) {
    const Clip clip = Parse(text, {.timecode_rate = rate});
    EXPECT_THAT(clip.timecodes, ElementsAre(std::nullopt, std::nullopt)) << rate;
    EXPECT_NEAR(clip.times[1], 5.0 / rate, 1e-9);
  }
  for (const double rate : {29.97, 30'000.0 / 1001.0}) {
    EXPECT_EQ(Parse(text, {.timecode_rate = rate}).timecodes[0],
              (Timecode{.frame = 300, .rate_numerator = 30'000, .rate_denominator = 1001}));
  }
  EXPECT_EQ(Parse(text, {.timecode_rate = 25.0}).timecodes[0],
            (Timecode{.frame = 250, .rate_numerator = 25}));
}

struct Written {
  std::string first;  // timecode
  Clip read;
  std::vector<std::string> warnings;
};

Written WriteAndRead(const Clip& clip) {
  ClipReport report;
  const std::string text = *LiveLinkCsvToText(clip, &report);
  return {text.substr(text.find('\n') + 1, 11), Parse(text), report.warnings};
}

// A take of `frames` poses, one every `step` frames of timecode, from 01:00:00:00.
Clip MakeTimedTake(std::uint32_t numerator, std::uint32_t denominator, int frames, double step) {
  const double rate = static_cast<double>(numerator) / denominator;
  Clip clip = MakeTake(rate / step, frames);
  const std::int64_t hour =
      TimecodeFramesPerDay(*MakeTimecode(0, 0.0, numerator, denominator)) / 24;
  for (int f = 0; f < frames; ++f) {
    const double frame = f * step;
    const double whole = std::floor(frame);
    clip.timecodes.push_back(MakeTimecode(hour + static_cast<std::int64_t>(whole), frame - whole,
                                          numerator, denominator));
  }
  return clip;
}

TEST(LiveLinkCsv, WritesTimecodesThatGiveTheTimesBack) {
  for (const auto& [numerator, denominator] : {std::pair<std::uint32_t, std::uint32_t>{24, 1},
                                               {25, 1},
                                               {30, 1},
                                               {60, 1},
                                               {120, 1},
                                               {30'000, 1001},
                                               {60'000, 1001},
                                               {24'000, 1001}}) {
    const Clip clip = MakeTimedTake(numerator, denominator, 900, 1.0);
    const Written written = WriteAndRead(clip);
    EXPECT_EQ(written.first.substr(0, 8), "01:00:00") << numerator;
    EXPECT_EQ(written.warnings.size(), 0u) << numerator;
    ASSERT_EQ(written.read.num_frames(), 900);
    // Only 23.976 frames per second are read 0.1% slow.
    const double error = numerator == 24'000 ? 0.0011 * clip.duration() : 1e-9;
    EXPECT_NEAR(written.read.times.back(), clip.times.back(), error) << numerator;
  }
}

TEST(LiveLinkCsv, TimecodesWithOtherTimesAreNotWritten) {
  // The clock of the shoot was set forward by ten hours.
  Clip jump = MakeTimedTake(60, 1, 180, 1.0);
  for (std::size_t i = 90; i < 180; ++i) jump.timecodes[i]->frame += 10 * 3600 * 60;
  // The reader would take them for 24, 100, 50 and 25 frames per second, and the last for 60.
  Clip slow = MakeTimedTake(15, 1, 150, 1.0);
  Clip fast = MakeTimedTake(72, 1, 720, 1.0);
  Clip sparse60 = MakeTimedTake(60, 1, 50, 12.0);
  Clip sparse30 = MakeTimedTake(30, 1, 50, 6.0);
  Clip brief = MakeTimedTake(30, 1, 15, 1.0);
  // Times of another speed.
  Clip half = MakeTimedTake(60, 1, 600, 1.0);
  for (double& time : half.times) time *= 0.5;
  for (const Clip* clip : {&jump, &slow, &fast, &sparse60, &sparse30, &brief, &half}) {
    const Written written = WriteAndRead(*clip);
    EXPECT_EQ(written.first, "00:00:00:00");
    EXPECT_THAT(written.warnings, ElementsAre(HasSubstr("starts at 00:00:00:00")));
    ASSERT_EQ(written.read.num_frames(), clip->num_frames());
    for (std::size_t i = 0; i < clip->times.size(); ++i) {
      EXPECT_NEAR(written.read.times[i], clip->times[i], 0.001 / 24.0);
    }
  }
}

// At 23.976 frames per second, the timecode is 3.6 s behind after an hour.
TEST(LiveLinkCsv, ASlowTimecodeIsWrittenOnlyWithinItsTolerance) {
  const Clip slow = MakeTimedTake(24'000, 1001, 3600 * 24, 1.0);
  const Written written = WriteAndRead(slow);
  EXPECT_EQ(written.first, "01:00:00:00");
  EXPECT_NEAR(written.read.times.back(), slow.times.back() / 1.001, 1e-3);
  // 1.5 s beside the clock is within the 7.2 s that an hour may differ, but not within a minute's 1
  // s.
  for (const auto& [frames, first] :
       {std::pair{3600 * 30, "01:00:00:00"}, {60 * 30, "00:00:00:00"}}) {
    Clip clip = MakeTimedTake(30, 1, frames, 1.0);
    for (std::size_t i = 1; i < clip.times.size(); ++i) clip.times[i] += 1.5;
    EXPECT_EQ(WriteAndRead(clip).first, first);
  }
}

// The reader cannot infer the smallest rate that fits from uneven or few frames.
TEST(LiveLinkCsv, WithoutTimecodesTheReaderGetsTheTimesBack) {
  for (const double rate : {5.0, 15.0, 26.0, 30.0, 49.0, 72.0, 90.0, 120.0, 240.0}) {
    for (const double seconds : {0.2, 0.5, 0.99999999, 1.0, 1.2, 3.0}) {
      Clip clip = MakeTake(rate, static_cast<int>(rate * seconds) + 2);
      clip.times.back() = std::max(seconds, clip.times[clip.times.size() - 2] + 0.001);
      const Clip read = WriteAndRead(clip).read;
      ASSERT_EQ(read.num_frames(), clip.num_frames());
      for (std::size_t i = 0; i < clip.times.size(); ++i) {
        EXPECT_NEAR(read.times[i], clip.times[i], 0.001 / 24.0)
            << rate << " Hz, " << seconds << " s";
      }
    }
  }
  Clip uneven = MakeTake(1.0, 5);
  uneven.times = {0.0, 0.01, 0.02, 0.03, 1.1};  // 30 frames per second or less, by the mean
  EXPECT_NEAR(WriteAndRead(uneven).read.times[3], 0.03, 1e-4);
  uneven.times = {0.0, 0.001, 0.002, 0.003, 0.1};  // 48
  EXPECT_NEAR(WriteAndRead(uneven).read.times[4], 0.1, 1e-4);
}

// A file with them could not be read again as it is.
TEST(LiveLinkCsv, TimecodesThatDoNotRiseAreNotWritten) {
  const auto first_of = [](std::vector<std::optional<Timecode>> timecodes) {
    Clip clip = MakeTake(60.0, 3);
    clip.timecodes = std::move(timecodes);
    return WriteAndRead(clip).first;
  };
  const auto at = [](std::uint32_t frame) { return MakeTimecode(frame, 0.0, 60, 1); };
  EXPECT_EQ(first_of({at(600), at(601), at(602)}), "00:00:10:00");
  EXPECT_EQ(first_of({at(60 * 86'400 - 1), at(0), at(1)}), "23:59:59:59") << "midnight";
  EXPECT_EQ(first_of({at(600), at(600), at(602)}), "00:00:00:00") << "repeated";
  EXPECT_EQ(first_of({at(600), at(100), at(602)}), "00:00:00:00") << "back";
  EXPECT_EQ(first_of({at(600), std::nullopt, at(602)}), "00:00:00:00") << "missing";
  EXPECT_EQ(first_of({at(600), MakeTimecode(601, 0.0, 25, 1), at(602)}), "00:00:00:00")
      << "another rate";
}

TEST(LiveLinkCsv, RejectsClipsThatTheCsvCannotExpress) {
  EXPECT_EQ(LiveLinkCsvToText(Clip()).status().code(), StatusCode::kUnsupported);
  Clip none = MakeTake(60.0, 0);
  EXPECT_EQ(LiveLinkCsvToText(none).status().code(), StatusCode::kInvalidArgument);
  Clip comma = MakeTake(60.0, 2);
  comma.blend_shape_names[0] = "a,b";
  EXPECT_EQ(LiveLinkCsvToText(comma).status().code(), StatusCode::kInvalidArgument);
  Clip day = MakeTake(1e-5, 3);
  EXPECT_EQ(LiveLinkCsvToText(day).status().code(), StatusCode::kLimit);
  day.times = {0.0, 1.0, 86399.9999999};  // would round to 24:00:00:00
  EXPECT_EQ(LiveLinkCsvToText(day).status().code(), StatusCode::kLimit);
}

TEST(LiveLinkCsv, HandlesEveryTruncation) {
  const std::string whole = *LiveLinkCsvToText(MakeTake(60.0, 3));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    const Result<Clip> clip = ParseLiveLinkCsv({cut.data(), cut.size()}, "t.csv");
    if (clip.ok()) {
      EXPECT_LE(clip->num_frames(), 3);
      EXPECT_EQ(clip->blend_shapes.size(), clip->times.size() * clip->blend_shape_names.size());
    } else {
      EXPECT_THAT(clip.status().where(), HasSubstr("t.csv:"));
    }
  }
}

TEST(LiveLinkCsv, SurvivesGarbage) {
  std::uint32_t state = 7;
  const std::string good = *LiveLinkCsvToText(MakeTake(60.0, 5));
  for (int round = 0; round < 2000; ++round) {
    std::string text = good;
    for (int i = 0; i < 3; ++i) {
      state = state * 1664525u + 1013904223u;
      text[(state >> 8) % text.size()] = static_cast<char>(state >> 24);
    }
    const Result<Clip> clip = ParseLiveLinkCsv(text, "t.csv");
    if (!clip.ok()) continue;
    for (std::size_t f = 1; f < clip->times.size(); ++f) {
      EXPECT_GT(clip->times[f], clip->times[f - 1]);
    }
    ASSERT_EQ(clip->timecodes.size(), clip->times.size());
    for (const auto& timecode : clip->timecodes) EXPECT_TRUE(!timecode || IsValid(*timecode));
  }
}

}  // namespace
}  // namespace furrow::motion
