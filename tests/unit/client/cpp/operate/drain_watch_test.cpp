// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/operate/drain_watch.h"

#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

namespace furrow::client {
namespace {

using Verdict = DrainWatch::Verdict;
using protocol::DrainState;

constexpr std::int64_t kStartUs = 50'000'000;
constexpr std::int64_t kSecond = 1'000'000;

std::optional<DrainState> Left(std::uint32_t subjects) {
  return DrainState{.draining = true, .moved = 1, .left = subjects, .names = {}, .why = {}};
}

TEST(DrainWatch, GivesUpWithoutAFirstAnswer) {
  for (const bool waits : {false, true}) {
    const DrainWatch watch(kStartUs, waits, 0);
    const std::int64_t end_us = kStartUs + DrainWatch::kPatienceUs;
    EXPECT_EQ(watch.Judge({}, 0, end_us - 1), Verdict::kGoesOn);
    EXPECT_EQ(watch.Judge({}, 0, end_us), Verdict::kNoAnswer);
  }
}

TEST(DrainWatch, AnAnswerIsEnoughForWhoeverDoesNotWait) {
  const DrainWatch watch(kStartUs, false, 0);
  EXPECT_EQ(watch.Judge(Left(3), kStartUs, kStartUs), Verdict::kAgreed);
}

TEST(DrainWatch, EndsWhenNoSubjectIsLeft) {
  const DrainWatch watch(kStartUs, true, 0);
  EXPECT_EQ(watch.Judge(Left(1), kStartUs, kStartUs), Verdict::kGoesOn);
  EXPECT_EQ(watch.Judge(Left(0), kStartUs, kStartUs), Verdict::kEmpty);
  // A daemon without subjects that does not drain yet.
  EXPECT_EQ(watch.Judge(DrainState{}, kStartUs, kStartUs), Verdict::kGoesOn);
}

TEST(DrainWatch, WaitsForHoursWhileTheDaemonAnswers) {
  const DrainWatch watch(kStartUs, true, 0);
  const std::int64_t now_us = kStartUs + 7200 * kSecond;
  EXPECT_EQ(watch.Judge(Left(1), now_us - kSecond, now_us), Verdict::kGoesOn);
}

TEST(DrainWatch, NoticesADaemonThatNoLongerAnswers) {
  const DrainWatch watch(kStartUs, true, 0);
  const std::int64_t heard_us = kStartUs + 60 * kSecond;
  EXPECT_EQ(watch.Judge(Left(1), heard_us, heard_us + DrainWatch::kSilenceUs), Verdict::kGoesOn);
  EXPECT_EQ(watch.Judge(Left(1), heard_us, heard_us + DrainWatch::kSilenceUs + 1),
            Verdict::kSilent);
  // What it said last counts all the same.
  EXPECT_EQ(watch.Judge(Left(0), heard_us, heard_us + 2 * DrainWatch::kSilenceUs), Verdict::kEmpty);
}

TEST(DrainWatch, StopsAtTheLimit) {
  const DrainWatch watch(kStartUs, true, 5 * kSecond);
  const std::int64_t end_us = kStartUs + 5 * kSecond;
  EXPECT_EQ(watch.Judge(Left(1), end_us, end_us), Verdict::kGoesOn);
  EXPECT_EQ(watch.Judge(Left(1), end_us, end_us + 1), Verdict::kTimedOut);
}

}  // namespace
}  // namespace furrow::client
