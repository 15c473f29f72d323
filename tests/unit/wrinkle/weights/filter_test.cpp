// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "tests/unit/wrinkle/oracle/filter_oracle.h"
#include "tests/unit/wrinkle/oracle/one_euro.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::wrinkle {
namespace {

// The solver's filter, on a rig with a single driver: its value is the input.
class FilterTest : public testing::Test {
 protected:
  float Step(float input, double dt) {
    pose_.blend_shapes = {input};
    EXPECT_EQ(Solver().Update(pose_, dt), JobStatus::kOk);
    return Output();
  }
  float Lose(double dt) {
    EXPECT_EQ(Solver().Decay(dt), JobStatus::kOk);
    return Output();
  }
  // Starts again, with filter_ as it is now.
  void Restart() { solver_.reset(); }
  float Output() { return Solver().filtered_values()[0]; }
  SubjectSolver& Solver() {
    if (!solver_) {
      Rig rig;
      rig.filter = filter_;
      rig.drivers.resize(1);
      rig.drivers[0].name = "input";
      rig.drivers[0].kind = Driver::Kind::kBlendShape;
      rig.drivers[0].blend_shape.blend_shape = "input";
      solver_.emplace(BoundRig(rig, Skeleton(), {"input"}).binding());
    }
    return *solver_;
  }

  Filter filter_;
  std::optional<SubjectSolver> solver_;
  LocalPose pose_;
};

TEST(OneEuro, LowPassShareIsThatOfAFirstOrderFilter) {
  EXPECT_EQ(LowPassShare(1.0, 0.0), 0.0);
  // tau = 1 / (2 pi) s; dt = tau: 1 - 1 / e.
  EXPECT_NEAR(LowPassShare(1.0, 0.15915494), 0.63212056, 1e-6);
  EXPECT_NEAR(LowPassShare(4.0, 1.0 / 60.0), 0.342211, 1e-5);  // 1 - exp(-8 pi / 60)
  EXPECT_NEAR(LowPassShare(1.0, 1e9), 1.0, 1e-8);
}

// Two steps at 10 Hz by hand: min cut-off 1 Hz, beta 2, derivative cut-off 1 Hz.
TEST(OneEuro, FollowsAWorkedExample) {
  const OneEuro filter{.min_cutoff_hz = 1.0, .beta = 2.0, .derivative_cutoff_hz = 1.0};
  double speed = 0.0;
  // exp(-0.2 pi) = 0.533488: speed = 5 (1 - 0.533488) = 2.332560, and its mean 5 (1 - 0.466512 /
  // 0.628319) = 1.287616. Cut-off 3.575232 Hz, a = 22.463848 / s: the value ends behind the line by
  // 5 / a (1 - exp(-0.1 a)) = 0.222580 * (1 - 0.105781).
  const double first = filter.Step(0.0, 0.5, 5.0, 0.1, &speed);
  EXPECT_NEAR(speed, 2.332560, 1e-5);
  EXPECT_NEAR(first, 0.5 - 0.222580 * (1.0 - 0.105781), 1e-5);
  // The input rests. speed = 2.332560 * 0.533488, its mean 2.332560 * 0.466512 / 0.628319 =
  // 1.731871; cut-off 4.463743 Hz: exp(-0.893 pi) = 0.060528 of the way is left.
  const double second = filter.Step(first, 0.5, 0.0, 0.1, &speed);
  EXPECT_NEAR(speed, 1.244393, 1e-5);
  EXPECT_NEAR(second, 0.5 - 0.060528 * (0.5 - first), 1e-5);
}

TEST_F(FilterTest, FirstInputPassesUnchanged) { EXPECT_EQ(Step(0.83f, 0.0), 0.83f); }

TEST_F(FilterTest, OutputsStayInRange) {
  EXPECT_EQ(Step(7.0f, 0.0), 1.0f);
  for (int i = 0; i < 50; ++i) {
    const float output = Step(i % 2 == 0 ? -1e30f : 1e30f, 0.01);
    EXPECT_GE(output, 0.0f);
    EXPECT_LE(output, 1.0f);
  }
}

TEST_F(FilterTest, RestIsSteadierAndMotionArrives) {
  std::mt19937 random(4);
  std::normal_distribution<float> jitter(0.0f, 0.02f);
  filter_.min_cutoff_hz = 1.0f;
  double raw = 0.0;
  double smooth = 0.0;
  Step(0.5f, 0.0);
  for (int i = 0; i < 600; ++i) {
    const float input = 0.5f + jitter(random);
    const float output = Step(input, 1.0 / 60.0);
    raw += (input - 0.5f) * (input - 0.5f);
    smooth += (output - 0.5f) * (output - 0.5f);
  }
  EXPECT_LT(std::sqrt(smooth), 0.5 * std::sqrt(raw));
  for (int i = 0; i < 60; ++i) Step(1.0f, 1.0 / 60.0);
  EXPECT_NEAR(Step(1.0f, 1.0 / 60.0), 1.0f, 0.01f);
}

TEST_F(FilterTest, BetaShortensTheLagOfFastMotion) {
  const auto lag = [&](float beta) {
    filter_ = Filter{.min_cutoff_hz = 1.0f, .beta = beta, .slew_per_second = 0.0f};
    Restart();
    float output = Step(0.0f, 0.0);
    for (int i = 1; i <= 6; ++i) output = Step(static_cast<float>(i) / 6.0f, 1.0 / 60.0);
    return 1.0f - output;
  };
  EXPECT_LT(lag(5.0f), 0.6f * lag(0.0f));
}

// Gestures of up to 3 Hz, sampled at several rates: shipped_rigs_test.cpp does the same with
// recordings.
TEST_F(FilterTest, HardlyDependsOnTheFrameRate) {
  const auto gesture = [](double t) {
    return 0.5 + 0.35 * std::sin(2.0 * M_PI * t) + 0.15 * std::sin(6.0 * M_PI * t + 1.0);
  };
  const auto fast = [](double t) { return 0.5 + 0.5 * std::sin(6.0 * M_PI * t); };
  const auto at_30_hz = [&](auto signal, int rate) {
    Restart();
    std::vector<float> outputs;
    for (int i = 0; i <= 2 * rate; ++i) {
      const double dt = 1.0 / rate;
      Step(static_cast<float>(signal(i * dt)), i == 0 ? 0.0 : dt);
      if (i % (rate / 30) == 0) outputs.push_back(Output());
    }
    return outputs;
  };
  const auto check = [&](auto signal) {
    const std::vector<float> expected = at_30_hz(signal, 240);
    for (const auto& [rate, bound] : {std::pair(30, 0.02f), {60, 0.006f}, {120, 0.002f}}) {
      const std::vector<float> outputs = at_30_hz(signal, rate);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_NEAR(outputs[i], expected[i], bound) << rate << " Hz, at " << i / 30.0 << " s";
      }
    }
  };
  check(gesture);
  check(fast);
}

// A straight line, sampled anyhow, gives the same output.
TEST_F(FilterTest, FollowsALineExactlyAtAnyRate) {
  filter_.beta = 0.0f;
  const auto after = [&](const std::vector<double>& steps) {
    Restart();
    Step(0.1f, 0.0);
    double t = 0.0;
    for (const double dt : steps) Step(static_cast<float>(0.1 + (t += dt)), dt);
    return Output();
  };
  const float expected = after(std::vector<double>(240, 1.0 / 480.0));
  EXPECT_NEAR(after({0.5}), expected, 2e-5f);
  EXPECT_NEAR(after({0.01, 0.2, 0.003, 0.287}), expected, 2e-5f);
  // It lags by the time constant 1 / (8 pi) s.
  EXPECT_NEAR(expected, 0.6f - 0.0397887f, 2e-5f);
}

TEST_F(FilterTest, SlewLimitsTheChange) {
  filter_.min_cutoff_hz = 1000.0f;
  filter_.slew_per_second = 2.0f;
  Step(0.0f, 0.0);
  EXPECT_NEAR(Step(1.0f, 0.1), 0.2f, 1e-6f);
  EXPECT_NEAR(Step(1.0f, 0.1), 0.4f, 1e-6f);
  EXPECT_NEAR(Step(0.0f, 0.05), 0.3f, 1e-6f);
}

TEST_F(FilterTest, TimeThatStandsStillChangesNothing) {
  Step(0.2f, 0.0);
  EXPECT_EQ(Step(0.9f, 0.0), 0.2f);
  EXPECT_EQ(Step(0.9f, 1e-300), 0.2f);
  EXPECT_GT(Step(0.9f, 0.1), 0.2f);
}

TEST_F(FilterTest, AVeryLongStepArrives) {
  for (const double dt : {1e3, 1e9, 1e300}) {
    Restart();
    Step(0.1f, 0.0);
    EXPECT_NEAR(Step(0.7f, dt), 0.7f, 1e-3f) << dt;
    EXPECT_EQ(Lose(dt), 0.0f) << dt;
  }
}

TEST_F(FilterTest, HoldsThenDecays) {
  filter_.hold_seconds = 0.25f;
  filter_.decay_seconds = 0.5f;
  filter_.slew_per_second = 0.0f;
  Step(0.8f, 0.0);
  EXPECT_EQ(Lose(0.1), 0.8f);
  EXPECT_EQ(Lose(0.15), 0.8f);
  EXPECT_NEAR(Lose(0.5), 0.8f * std::exp(-1.0f), 1e-6f);
  EXPECT_NEAR(Lose(0.25), 0.8f * std::exp(-1.5f), 1e-6f);
  for (int i = 0; i < 100; ++i) Lose(0.1);
  EXPECT_EQ(Output(), 0.0f);
}

TEST_F(FilterTest, DecayDoesNotDependOnTheSteps) {
  filter_.slew_per_second = 0.0f;
  Step(1.0f, 0.0);
  const float at_once = Lose(1.0);
  Restart();
  Step(1.0f, 0.0);
  for (int i = 0; i < 1000; ++i) Lose(0.001);
  EXPECT_NEAR(Output(), at_once, 1e-3f);
}

TEST_F(FilterTest, DecayObeysTheSlewLimit) {
  filter_ = Filter{.slew_per_second = 1.0f, .hold_seconds = 0.0f, .decay_seconds = 0.0f};
  Step(1.0f, 0.0);
  EXPECT_NEAR(Lose(0.1), 0.9f, 1e-6f);
}

TEST_F(FilterTest, InputAfterALossIsMetWithoutAJump) {
  Step(0.9f, 0.0);
  const float before = Lose(1.5);
  const float after = Step(0.9f, 1.0 / 60.0);
  EXPECT_GT(after, before);
  EXPECT_LE(after - before, filter_.slew_per_second / 60.0f + 1e-6f);
  EXPECT_LT(after, 0.6f);
}

TEST_F(FilterTest, LossBeforeAnyInputIsNeutral) { EXPECT_EQ(Lose(10.0), 0.0f); }

TEST_F(FilterTest, DisabledPassesInputButStillDecays) {
  filter_.enabled = false;
  EXPECT_EQ(Step(0.1f, 0.0), 0.1f);
  EXPECT_EQ(Step(1.0f, 0.001), 1.0f);
  EXPECT_EQ(Step(0.3f, 0.0), 0.3f);
  EXPECT_EQ(Lose(0.2), 0.3f);
  EXPECT_LT(Lose(1.0), 0.3f);
}

TEST_F(FilterTest, ResetForgets) {
  Step(1.0f, 0.0);
  Solver().Reset();
  EXPECT_EQ(Lose(0.0), 0.0f);
  EXPECT_EQ(Step(0.4f, 0.0), 0.4f);
}

TEST_F(FilterTest, RejectsBadTimes) {
  Step(0.3f, 0.0);
  for (const double dt : {-1e-9, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_EQ(Solver().Update(pose_, dt), JobStatus::kBadTime) << dt;
    EXPECT_EQ(Solver().Decay(dt), JobStatus::kBadTime) << dt;
  }
  EXPECT_EQ(Output(), 0.3f);
}

// Chance inputs, times, losses and parameters: the solver's filter in single precision against the
// oracle in double.
TEST_F(FilterTest, FollowsTheOracle) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (int round = 0; round < 50; ++round) {
    filter_ = {.enabled = round % 10 != 0,
               .min_cutoff_hz = 0.5f + 10.0f * uniform(random),
               .beta = 5.0f * uniform(random),
               .derivative_cutoff_hz = 0.5f + 5.0f * uniform(random),
               .slew_per_second = round % 3 == 0 ? 0.0f : 60.0f * uniform(random)};
    Restart();
    FilterOracle oracle(filter_, 1);
    for (int i = 0; i < 100; ++i) {
      const double dt = i % 7 == 0 ? 0.0 : 0.05 * uniform(random);
      if (i % 9 == 8) {
        oracle.Decay(dt);
        Lose(dt);
      } else {
        const float input = uniform(random);
        oracle.Update({&input, 1}, dt);
        Step(input, dt);
      }
      EXPECT_NEAR(Output(), oracle.values()[0], 2e-6f) << round << " " << i;
    }
  }
}

}  // namespace
}  // namespace furrow::wrinkle
