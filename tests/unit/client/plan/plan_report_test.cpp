// SPDX-License-Identifier: Apache-2.0
#include "client/plan/plan_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::plan {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string TextOf(const Demand& demand, const Machine& machine) {
  const Costs& costs = ShippedCosts();
  return ToText(MakePlan(demand, costs, machine), demand, machine, costs);
}

TEST(PlanReport, NamesTheMachinesAndWhatLimitsThem) {
  const std::string text = TextOf({.performers = 10'000, .subscribers = 3}, {});
  EXPECT_THAT(text, HasSubstr("10,000 performers: 51 joints, 37 weights, 60 Hz, 3 subscribers"));
  EXPECT_THAT(text, HasSubstr("600,000/s"));
  EXPECT_THAT(text, HasSubstr("1,800,000/s"));
  EXPECT_THAT(text, HasSubstr("the processor is the limit"));
  EXPECT_THAT(text, HasSubstr("'AMD EPYC'"));
  EXPECT_THAT(text, Not(HasSubstr("viewer")));
  EXPECT_THAT(TextOf({.performers = 10'000}, {.cores = 64, .gigabits = 1.0, .spares = 0}),
              HasSubstr("the network is the limit.\n"));
}

TEST(PlanReport, WarnsOfPosesInSeveralDatagrams) {
  EXPECT_THAT(TextOf({.performers = 1, .joints = 400}, {}), HasSubstr("does not fit one datagram"));
  EXPECT_THAT(TextOf({.performers = 1}, {}), Not(HasSubstr("does not fit")));
}

TEST(PlanReport, SaysWhenAMachineIsTooSmall) {
  EXPECT_THAT(TextOf({.performers = 1, .rate = 1000.0}, {.gigabits = 0.001}),
              HasSubstr("does not serve one performer"));
}

TEST(PlanReport, ProgramsGetTheSameFigures) {
  const Demand demand{.performers = 1'234, .viewers = 2};
  const Capacity plan = MakePlan(demand, ShippedCosts(), {});
  const nlohmann::json json = ToJson(plan, demand, {});
  EXPECT_EQ(json["machines"], plan.machines);
  EXPECT_EQ(json["poses_per_second"], 1'234 * 60.0);
  EXPECT_EQ(json["gpus"], plan.gpus);
}

}  // namespace
}  // namespace furrow::plan
