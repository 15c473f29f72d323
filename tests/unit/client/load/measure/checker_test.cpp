// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/checker.h"

#include <algorithm>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/client/load/workload_testing.h"

namespace furrow::load {
namespace {

constexpr std::int64_t kLatencyUs = 300;

// A simulated server that solves the poses it receives, per subject.
class Server {
 public:
  Server(const Workload& workload, const Plan& plan) : workload_(workload), plan_(plan) {
    for (int i = 0; i < plan.num_subjects(); ++i)
      subjects_.push_back({wrinkle::SubjectSolver(workload.binding), {}});
  }

  std::vector<float> Use(const Plan::Slot& slot) {
    Subject& subject = subjects_[slot.subject];
    const int phase = plan_.phase_of(slot.subject);
    const std::int64_t now =
        plan_.CaptureUs(phase, slot.pose) + plan_.ClockOffsetUs(slot.subject, slot.pose);
    const std::int64_t step = now - subject.last_us.value_or(now);
    if (step < 0) subject.solver.Reset();
    const double dt = std::max(0.0, static_cast<double>(step) * 1e-6);
    subject.last_us = now;
    wrinkle::LocalPose pose;
    workload_.pose(plan_.Frame(phase, slot.pose), &pose);
    EXPECT_EQ(subject.solver.Update(pose, dt), wrinkle::JobStatus::kOk);
    const auto weights = subject.solver.wrinkle_weights();
    return {weights.begin(), weights.end()};
  }
  // The server's clock says that a second has passed without poses.
  void Decay(std::uint32_t subject) {
    EXPECT_EQ(subjects_[subject].solver.Decay(1.0), wrinkle::JobStatus::kOk);
  }

 private:
  struct Subject {
    wrinkle::SubjectSolver solver;
    std::optional<std::int64_t> last_us;
  };
  const Workload& workload_;
  const Plan& plan_;
  std::vector<Subject> subjects_;
};

class CheckerTest : public testing::Test {
 protected:
  const Workload workload_ = MakePerformance();
  const Plan plan_{workload_.times, {.subjects = 5, .phases = 4, .rate = 50.0, .seconds = 8.0}};
  const ExpectedWeights expected_{workload_, plan_, [](double) { return true; }};
  Checker checker_{plan_, &expected_, {.watchers = 1, .late_us = 1000, .seconds = 8.0}};
  Server server_{workload_, plan_};

  void Arrive(const Plan::Slot& slot, const std::vector<float>& values,
              std::int64_t latency_us = kLatencyUs) {
    checker_.OnWeights(0, slot.subject, slot.pose, values, true, slot.due_us + latency_us);
  }
  // Sends all poses; `on_way(i, slot)` decides the fate of the i-th pose.
  template <class OnWay>
  const Tally& Run(const OnWay& on_way) {
    std::size_t i = 0;
    for (const Plan::Slot& slot : SlotsOf(plan_)) {
      checker_.OnDue(slot.subject, slot.pose, true);
      on_way(i++, slot);
    }
    EXPECT_TRUE(checker_.ResolveMismatches(workload_, [](double) { return true; }));
    return checker_.tally();
  }
};

TEST_F(CheckerTest, CorrectWeightsPass) {
  const Tally& tally = Run([&](std::size_t, const auto& slot) { Arrive(slot, server_.Use(slot)); });
  EXPECT_EQ(tally.offered, 2000u);
  EXPECT_EQ(tally.received, 2000u);
  EXPECT_EQ(tally.checked, 2000u);
  EXPECT_EQ(tally.lost() + tally.late + tally.wrong + tally.duplicates + tally.reordered, 0u);
  EXPECT_TRUE(checker_.complete());
  EXPECT_NEAR(static_cast<double>(checker_.latency_ns().max()), 1e3 * kLatencyUs, 1e3);
}

TEST_F(CheckerTest, EarlyArrivalsAreCountedWithALatencyOfZero) {
  const Plan::Slot slot = SlotsOf(plan_)[100];
  checker_.OnDue(slot.subject, slot.pose, true);
  checker_.OnWeights(0, slot.subject, slot.pose, server_.Use(slot), true, slot.due_us - 1);
  EXPECT_EQ(checker_.tally().received, 1u);
  EXPECT_EQ(checker_.tally().early, 1u);
  EXPECT_EQ(checker_.latency_ns().max(), 0);
}

TEST_F(CheckerTest, OneFalsifiedWeightIsWrong) {
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    auto values = server_.Use(slot);
    if (i == 777) values[1] += values[1] < 0.5f ? 0.5f : -0.5f;
    Arrive(slot, values);
  });
  EXPECT_EQ(tally.wrong, 1u);
  EXPECT_EQ(tally.swapped, 0u);
}

TEST_F(CheckerTest, ExchangedWeightsAreSwapped) {
  std::vector<float> kept;
  Plan::Slot first;
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    const auto values = server_.Use(slot);
    if (i == 500) {
      kept = values;
      first = slot;
    } else if (i == 501) {
      Arrive(first, values);
      Arrive(slot, kept);
    } else {
      Arrive(slot, values);
    }
  });
  EXPECT_EQ(tally.wrong, 2u);
  EXPECT_EQ(tally.swapped, 2u);
}

// The server's filter then sees another time step, so its weights differ from the table although
// the server is correct.
TEST_F(CheckerTest, PosesLostOnTheWayInMakeNothingWrong) {
  const std::set<std::size_t> lost = {0, 3, 500, 501, 502, 600, 605, 1500};
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    if (!lost.contains(i)) Arrive(slot, server_.Use(slot));
  });
  EXPECT_EQ(tally.lost(), lost.size());
  EXPECT_EQ(tally.wrong, 0u);
  EXPECT_EQ(tally.checked, 2000u - lost.size());
  EXPECT_GT(tally.largest_difference, 0.0f);
}

TEST_F(CheckerTest, WeightsLostOnTheWayOutMakeNothingWrong) {
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    const auto values = server_.Use(slot);
    if (i % 97 != 0) Arrive(slot, values);
  });
  EXPECT_EQ(tally.lost(), 21u);
  EXPECT_EQ(tally.wrong, 0u);
}

TEST_F(CheckerTest, AWrongWeightIsFoundAmongLostOnes) {
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    if (i % 50 == 3) return;  // lost on the way in
    auto values = server_.Use(slot);
    if (i == 1004) values[0] += values[0] < 0.5f ? 0.4f : -0.4f;
    if (i % 50 != 13) Arrive(slot, values);  // lost on the way out
  });
  EXPECT_EQ(tally.lost(), 80u);
  EXPECT_EQ(tally.wrong, 1u);
}

// Half of the poses of a second are lost at random: too many possibilities to follow, and no fault.
TEST_F(CheckerTest, HeavyLossInBothDirectionsMakesNothingWrong) {
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    const std::size_t dice = (i * 2654435761u >> 7) % 100;
    if (dice < 45) return;
    const auto values = server_.Use(slot);
    if (dice < 70) Arrive(slot, values);
  });
  EXPECT_GT(tally.lost(), 1000u);
  EXPECT_EQ(tally.wrong, 0u);
}

// After half a second without poses a server holds and decays weights by its own clock.
TEST_F(CheckerTest, AfterALongGapWeightsAreUnchecked) {
  const Tally& tally = Run([&](std::size_t, const auto& slot) {
    if (slot.subject == 2 && slot.pose >= 100 && slot.pose < 140) return;
    auto values = server_.Use(slot);
    if (slot.subject == 2 && slot.pose == 140) values = {0.9f, 0.9f, 0.9f};
    Arrive(slot, values);
  });
  EXPECT_EQ(tally.lost(), 40u);
  EXPECT_EQ(tally.wrong, 0u);
  EXPECT_GT(tally.unchecked, 0u);
}

// The load generator, or the network, paused: no pose is missing, but the server decayed.
TEST_F(CheckerTest, AfterADecayThatTheServerReportsWeightsAreUnchecked) {
  const Tally& tally = Run([&](std::size_t, const auto& slot) {
    if (slot.subject == 2 && slot.pose == 100) {
      server_.Decay(2);
      checker_.OnAged(0, 2, 99, slot.due_us - 2);
      checker_.OnAged(0, 2, 99, slot.due_us - 1);
    }
    Arrive(slot, server_.Use(slot));
  });
  EXPECT_EQ(tally.lost(), 0u);
  EXPECT_EQ(tally.wrong, 0u);
  EXPECT_GT(tally.unchecked, 0u);
  EXPECT_EQ(tally.aged, 2u);
}

TEST_F(CheckerTest, ADecayThatTheServerDoesNotReportIsWrong) {
  const Tally& tally = Run([&](std::size_t, const auto& slot) {
    if (slot.subject == 2 && slot.pose == 100) server_.Decay(2);
    Arrive(slot, server_.Use(slot));
  });
  EXPECT_GT(tally.wrong, 0u);
  EXPECT_EQ(tally.aged, 0u);
}

TEST_F(CheckerTest, ADecayExcusesNoOtherWeights) {
  const Tally& tally = Run([&](std::size_t, const auto& slot) {
    if (slot.subject == 2 && slot.pose == 100) checker_.OnAged(0, 2, 99, slot.due_us - 1);
    auto values = server_.Use(slot);
    // Another subject, a pose before the decay, and one two seconds after it.
    const bool is_wrong = (slot.subject == 1 && slot.pose == 100) ||
                          (slot.subject == 2 && (slot.pose == 99 || slot.pose == 200));
    if (is_wrong) values[1] += values[1] < 0.5f ? 0.5f : -0.5f;
    Arrive(slot, values);
  });
  EXPECT_EQ(tally.wrong, 3u);
  EXPECT_EQ(tally.unchecked, 0u);
}

TEST_F(CheckerTest, TheSilenceAfterTheLastPoseIsNoDecay) {
  const Plan::Slot last = SlotsOf(plan_).back();
  checker_.OnAged(0, last.subject, last.pose, last.due_us + 600'000);
  checker_.OnAged(0, 5, 0, 100);          // no such subject
  checker_.OnAged(0, 0, 1'000'000, 100);  // nor pose
  EXPECT_EQ(checker_.tally().aged, 0u);
}

// The filter restarts when a clock jumps back, and sees a long step when it jumps forward.
TEST(Checker, JumpsOfTheCaptureClockMakeNothingWrong) {
  const Workload workload = MakePerformance();
  const Plan plan(workload.times, {.subjects = 3,
                                   .phases = 3,
                                   .rate = 50.0,
                                   .seconds = 12.0,
                                   .clock_step = 3.0,
                                   .clock_every = 2.0});
  const ExpectedWeights expected(workload, plan, [](double) { return true; });
  Checker checker(plan, &expected, {.late_us = 1000, .seconds = 12.0});
  Server server(workload, plan);
  std::size_t i = 0;
  for (const Plan::Slot& slot : SlotsOf(plan)) {
    checker.OnDue(slot.subject, slot.pose, true);
    if (++i % 41 == 0) continue;  // lost on the way in, some of them at a jump
    auto values = server.Use(slot);
    if (i == 1000) values[1] += values[1] < 0.5f ? 0.5f : -0.5f;
    if (i % 43 == 0) continue;  // lost on the way out
    checker.OnWeights(0, slot.subject, slot.pose, values, true, slot.due_us + kLatencyUs);
  }
  EXPECT_TRUE(checker.ResolveMismatches(workload, [](double) { return true; }));
  EXPECT_EQ(checker.tally().wrong, 1u);
  EXPECT_EQ(checker.tally().unchecked, 0u);
  EXPECT_GT(checker.tally().largest_difference, 0.0f);
}

TEST_F(CheckerTest, CountsLateDuplicateReorderedAndNeverSent) {
  std::vector<float> kept;
  Plan::Slot first;
  const Tally& tally = Run([&](std::size_t i, const auto& slot) {
    const auto values = server_.Use(slot);
    if (i == 10) {
      kept = values;
      first = slot;
      return;
    }
    Arrive(slot, values, i == 300 ? 5000 : kLatencyUs);
    if (i == 400) Arrive(slot, values);
    if (i == 20) Arrive(first, kept);
    if (i == 30) checker_.OnWeights(0, 1, 1'000'000, values, true, slot.due_us);
  });
  EXPECT_EQ(tally.received, 2000u);
  EXPECT_EQ(tally.late, 1u);
  EXPECT_EQ(tally.duplicates, 1u);
  EXPECT_EQ(tally.reordered, 1u);
  EXPECT_EQ(tally.never_sent, 1u);
  EXPECT_EQ(tally.wrong, 0u);
}

TEST_F(CheckerTest, AnUnsentPoseIsNotExpected) {
  const Plan::Slot slot = SlotsOf(plan_)[0];
  checker_.OnDue(slot.subject, slot.pose, false);
  EXPECT_EQ(checker_.tally().expected, 0u);
  EXPECT_EQ(checker_.tally().offered, 1u);
  Arrive(slot, server_.Use(slot));
  EXPECT_EQ(checker_.tally().never_sent, 1u);
}

TEST_F(CheckerTest, AnUnknownSubjectIsNeverSent) {
  checker_.OnWeights(0, 5, 0, {}, false, 100);
  checker_.OnWeights(0, 65535, 0, {}, false, 100);
  EXPECT_EQ(checker_.tally().never_sent, 2u);
}

TEST_F(CheckerTest, ARowOfAnotherLengthIsWrong) {
  checker_.OnDue(0, 0, true);
  checker_.OnWeights(0, 0, 0, std::vector<float>{0.5f}, true, 100);
  EXPECT_EQ(checker_.tally().wrong, 1u);
}

TEST_F(CheckerTest, ACancelledResolutionCountsTheRestAsUnchecked) {
  for (const Plan::Slot& slot : SlotsOf(plan_)) {
    checker_.OnDue(slot.subject, slot.pose, true);
    if (slot.pose % 10 != 3) Arrive(slot, {0.2f, 0.3f, 0.4f});
  }
  int asked = 0;
  double share = 0.0;
  EXPECT_FALSE(checker_.ResolveMismatches(workload_, [&](double done) {
    EXPECT_GE(done, share);
    share = done;
    return ++asked <= 100;
  }));
  const Tally& tally = checker_.tally();
  EXPECT_EQ(asked, 101);
  EXPECT_EQ(tally.unchecked + tally.checked, 1800u);
  EXPECT_GE(tally.unchecked, 1700u);
}

// If all weights are wrong, all are counted and only the first ones are classified.
TEST(Checker, ClassifiesALimitedNumberOfWrongWeights) {
  const Workload workload = MakePerformance();
  const Plan plan(workload.times, {.subjects = 5, .phases = 4, .rate = 50.0, .seconds = 50.0});
  const ExpectedWeights expected(workload, plan, [](double) { return true; });
  Checker checker(plan, &expected, {.late_us = 1000, .seconds = 50.0});
  for (const Plan::Slot& slot : SlotsOf(plan)) {
    checker.OnDue(slot.subject, slot.pose, true);
    checker.OnWeights(0, slot.subject, slot.pose, std::vector<float>{2.0f, 2.0f, 2.0f}, true,
                      slot.due_us + kLatencyUs);
  }
  EXPECT_TRUE(checker.ResolveMismatches(workload, [](double) { return true; }));
  EXPECT_EQ(checker.tally().wrong, 12500u);
  EXPECT_EQ(checker.tally().unclassified, 2500u);
  EXPECT_EQ(checker.tally().falsified(), 10000u);
}

// A run of several minutes with one pose lost on the way in, near the end.
class LateLoss : public testing::TestWithParam<float> {};  // cut-off frequency of the filter, Hz

TEST_P(LateLoss, IsReplayedCorrectly) {
  Workload workload = MakePerformance({.min_cutoff_hz = GetParam(), .beta = 0.0f});
  const Plan plan(workload.times, {.subjects = 1, .phases = 1, .rate = 0.0, .seconds = 120.0});
  const ExpectedWeights expected(workload, plan, [](double) { return true; });
  Checker checker(plan, &expected, {.late_us = 1000, .seconds = 120.0});
  Server server(workload, plan);
  for (const Plan::Slot& slot : SlotsOf(plan)) {
    checker.OnDue(slot.subject, slot.pose, true);
    if (slot.pose == 5500) continue;
    checker.OnWeights(0, 0, slot.pose, server.Use(slot), true, slot.due_us + kLatencyUs);
  }
  int solved = 0;
  workload.pose = [&solved, pose = workload.pose](int frame, wrinkle::LocalPose* out) {
    ++solved;
    pose(frame, out);
  };
  EXPECT_TRUE(checker.ResolveMismatches(workload, [](double) { return true; }));
  EXPECT_EQ(checker.tally().lost(), 1u);
  EXPECT_EQ(checker.tally().wrong, 0u);
  EXPECT_EQ(checker.tally().checked, plan.num_slots() - 1);
  const bool forgets = GetParam() >= 1.0f;
  EXPECT_EQ(solved < 1000, forgets) << solved;
}

// The default cut-off, and one with a memory longer than a late replay.
INSTANTIATE_TEST_SUITE_P(Filters, LateLoss, testing::Values(4.0f, 0.05f));

TEST_F(CheckerTest, OtherNamesAreNotChecked) {
  checker_.OnDue(0, 0, true);
  checker_.OnWeights(0, 0, 0, std::vector<float>{1.0f}, false, 100);
  EXPECT_EQ(checker_.tally().unchecked, 1u);
}

// The table covers the memory of the filter; the run is longer.
TEST(ExpectedWeights, RepeatsOnceTheFilterHasSettled) {
  const Workload workload = MakePerformance();
  const Plan plan(workload.times, {.subjects = 1, .phases = 1, .rate = 0.0, .seconds = 60.0});
  const ExpectedWeights expected(workload, plan, [](double) { return true; });
  Server server(workload, plan);
  for (const Plan::Slot& slot : SlotsOf(plan))
    EXPECT_LE(Distance(expected.Row(0, slot.pose), server.Use(slot)), 1e-6f) << slot.pose;
}

}  // namespace
}  // namespace furrow::load
