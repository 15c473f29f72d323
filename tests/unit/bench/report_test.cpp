// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report/aims.h"
#include "bench/report/machine.h"

namespace furrow::bench {
namespace {

TEST(Aims, RoundTripThroughJson) {
  const std::vector<Aim> aims = {{"p50", "echo 74 us", "1.18x", "1.00x", "<= 1.25x", true},
                                 {"p90", "", "1.47x", "", "<= 1.30x", false}};
  const auto back = AimsFromJson(ToJson(aims));
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(ToMarkdown(*back, "control"), ToMarkdown(aims, "control"));
  EXPECT_EQ(AimsFromJson({{{"figure", "p50"}}}).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(AimsFromJson({1, 2}).status().code(), StatusCode::kInvalidArgument);
}

TEST(Machine, NamesTheProcessorOfTheFirstCore) {
  std::istringstream two(
      "processor\t: 0\nmodel\t\t: 17\nmodel name\t: AMD EPYC 9004\nprocessor\t: 1\n"
      "model name\t: other\n");
  EXPECT_EQ(ProcessorName(two), "AMD EPYC 9004");
  std::istringstream none("processor\t: 0\nBogoMIPS\t: 50.00\n");
  EXPECT_EQ(ProcessorName(none), "unknown processor");
}

TEST(Machine, TextStatesDateProcessorAndLoad) {
  EXPECT_EQ(ToText({"2026-11-21 18:30 UTC", "AMD EPYC", 2, 0.3, "g++ 12.2.0"}),
            "2026-11-21 18:30 UTC, 2 cores of AMD EPYC, g++ 12.2.0");
  EXPECT_EQ(ToText({"today", "X", 1, 0.0, "clang"}), "today, 1 core of X, clang");
  EXPECT_GE(ThisMachine().cores, 1);
}

}  // namespace
}  // namespace furrow::bench
