// SPDX-License-Identifier: Apache-2.0
#include "client/plan/capacity.h"

#include <gtest/gtest.h>

namespace furrow::plan {
namespace {

// Costs that are easy to reckon with: 10 us a pose, whatever the rate.
Costs RoundCosts() {
  Costs costs;
  costs.pose_us.points = {{1.0, 10.0}, {1e6, 10.0}};
  costs.joint_us = 0.1;
  costs.weight_us = 0.2;
  costs.subscriber_us = 3.0;
  costs.idle_bytes = 1e6;
  costs.subject_bytes = 1e3;
  return costs;
}

TEST(Capacity, FollowsFromThePriceOfAPose) {
  const Demand demand{.performers = 10'000, .rate = 60.0};
  const Capacity plan = MakePlan(demand, RoundCosts(), {.cores = 8, .load = 0.6});
  EXPECT_DOUBLE_EQ(plan.poses, 600'000.0);
  EXPECT_NEAR(plan.pose_us, 10.0, 1e-6);
  EXPECT_NEAR(plan.busy_cores, 6.0, 1e-6);
  EXPECT_EQ(plan.cores, 10.0) << "at 60%";
  EXPECT_NEAR(plan.by_processor, 8'000.0, 1.0);
  EXPECT_EQ(plan.bytes, 1e6 + 1e7);
}

TEST(Capacity, JointsWeightsSubscribersAndSealsCostTime) {
  const auto price = [](const Demand& demand) {
    return MakePlan(demand, RoundCosts(), {}).pose_us;
  };
  EXPECT_NEAR(price({.performers = 9}), 10.0, 1e-9);
  EXPECT_NEAR(price({.performers = 9, .joints = 61}), 11.0, 1e-9);
  EXPECT_NEAR(price({.performers = 9, .weights = 47}), 12.0, 1e-9);
  EXPECT_NEAR(price({.performers = 9, .subscribers = 4}), 19.0, 1e-9);
  EXPECT_NEAR(price({.performers = 9, .subscribers = 0}), 7.0, 1e-9);
  EXPECT_NEAR(price({.performers = 9, .joints = 1, .weights = 1}), 10.0, 1e-9)
      << "less was not measured";
  EXPECT_NEAR(price({.performers = 9, .is_sealed = true}), 12.3, 1e-9);
}

// The shipped curve: a busy core needs less time for each pose, and still more for all.
TEST(Capacity, ABusyCoreServesMore) {
  const auto plan = [](double performers, double load) {
    return MakePlan({.performers = performers}, ShippedCosts(), {.load = load});
  };
  EXPECT_GT(plan(50, 0.7).pose_us, plan(500, 0.7).pose_us);
  EXPECT_LT(plan(50, 0.7).busy_cores, plan(500, 0.7).busy_cores);
  EXPECT_EQ(plan(1'000, 0.7).cores, 1.0) << "as measured: 67% of a core";
  EXPECT_EQ(plan(1'400, 0.7).cores, 2.0) << "as measured: 82% of a core";
  EXPECT_LT(plan(1, 0.35).by_processor, plan(1, 0.7).by_processor);
}

// `docs/performance/load.md`: 64 subscribers of each of 16 subjects, and 400 joints of each of 100.
TEST(Capacity, ReproducesTheMeasuredRuns) {
  const auto busy = [](const Demand& demand) {
    return MakePlan(demand, ShippedCosts(), {}).busy_cores;
  };
  EXPECT_NEAR(busy({.performers = 16, .subscribers = 64}), 0.231, 0.06);
  EXPECT_NEAR(busy({.performers = 100, .joints = 400}), 0.247, 0.04);
  EXPECT_NEAR(busy({.performers = 100, .weights = 148}), 0.252, 0.05);
  EXPECT_NEAR(busy({.performers = 700}), 0.544, 0.01);
}

TEST(Capacity, TheTighterPartOfAMachineDecides) {
  const Demand demand{.performers = 1'000};
  const Capacity slow_link = MakePlan(demand, RoundCosts(), {.cores = 64, .gigabits = 0.1});
  EXPECT_LT(slow_link.by_network, slow_link.by_processor);
  EXPECT_EQ(slow_link.per_machine(), slow_link.by_network);
  const double bits = 8.0 * slow_link.pose.bytes * demand.rate;
  EXPECT_NEAR(slow_link.by_network, 0.7 * 0.1e9 / bits, 1.0);
  const Capacity one_core = MakePlan(demand, RoundCosts(), {.cores = 1, .gigabits = 100.0});
  EXPECT_EQ(one_core.per_machine(), one_core.by_processor);
  // Both directions of a link are free at the same time: only the busier one counts.
  const Capacity many = MakePlan({.performers = 1'000, .subscribers = 10}, RoundCosts(), {});
  EXPECT_NEAR(many.by_network, 0.7 * 10e9 / (8.0 * 10 * many.weights.bytes * 60.0), 1.0);
}

TEST(Capacity, TheMachinesServeAll) {
  for (const double performers : {1.0, 999.0, 10'000.0, 1e6}) {
    const Capacity plan = MakePlan({.performers = performers}, ShippedCosts(), {});
    EXPECT_GE(plan.machines * plan.per_machine(), performers);
    EXPECT_LT((plan.machines - 1) * plan.per_machine(), performers);
  }
}

TEST(Capacity, AMachineMayBeTooSmallForOnePerformer) {
  const Capacity plan =
      MakePlan({.performers = 5, .rate = 1000.0}, RoundCosts(), {.gigabits = 0.001});
  EXPECT_EQ(plan.by_network, 0.0);
  EXPECT_EQ(plan.machines, 0.0);
}

TEST(Capacity, PicturesNeedProcessorsOrGpus) {
  Demand demand{.performers = 10, .viewers = 4.0, .width = 640, .height = 400};
  demand.picture_rate = 37.0;
  const Capacity plan = MakePlan(demand, ShippedCosts(), {.load = 1.0});
  EXPECT_NEAR(plan.gpus, 1.0, 1e-9) << "148 pictures/s, as measured";
  EXPECT_NEAR(plan.picture_cores, 148 * 0.131 + plan.encoding_cores, 1e-9);
  EXPECT_NEAR(plan.encoding_cores, 148 * 6.74e-3 * 256'000 / 921'600, 1e-9);
  const Capacity unseen = MakePlan({.performers = 10}, ShippedCosts(), {});
  EXPECT_EQ(unseen.gpus, 0.0);
  EXPECT_GT(plan.bits_out, unseen.bits_out);
}

}  // namespace
}  // namespace furrow::plan
