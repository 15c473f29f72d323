// SPDX-License-Identifier: Apache-2.0
#include "bench/report/micro_results.h"

#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::bench {
namespace {

nlohmann::json OneRun(const std::string& name, double cpu_time, const std::string& unit = "ns") {
  return {{"name", name},      {"run_name", name},      {"run_type", "iteration"},
          {"iterations", 7},   {"real_time", 1e9},      {"cpu_time", cpu_time},
          {"time_unit", unit}, {"repetition_index", 0}, {"bytes_per_second", 100.0 * cpu_time}};
}

Result<MicroResults> Parse(const std::vector<nlohmann::json>& runs) {
  return MicroResults::Parse(nlohmann::json{{"benchmarks", runs}}.dump(), "here.json");
}

TEST(MicroResults, UsesTheMedianOfRepetitions) {
  const auto results = Parse({OneRun("BM_A/n:1", 5.0), OneRun("BM_B", 1.0), OneRun("BM_A/n:1", 3.0),
                              OneRun("BM_A/n:1", 100.0)});
  ASSERT_TRUE(results.ok());
  EXPECT_EQ(results->Nanoseconds("BM_A/n:1").value(), 5.0);
  EXPECT_EQ(results->Counter("BM_A/n:1", "bytes_per_second").value(), 500.0);
  EXPECT_EQ(results->Nanoseconds("BM_B").value(), 1.0);
}

TEST(MicroResults, ConvertsTimesToNanoseconds) {
  const auto results =
      Parse({OneRun("us", 2.0, "us"), OneRun("ms", 2.0, "ms"), OneRun("s", 2.0, "s")});
  ASSERT_TRUE(results.ok());
  EXPECT_EQ(results->Nanoseconds("us").value(), 2e3);
  EXPECT_EQ(results->Nanoseconds("ms").value(), 2e6);
  EXPECT_EQ(results->Nanoseconds("s").value(), 2e9);
}

// The means and deviations that Google Benchmark adds are not measurements.
TEST(MicroResults, IgnoresAggregates) {
  nlohmann::json mean = OneRun("BM_A", 1000.0);
  mean["run_type"] = "aggregate";
  const auto results = Parse({OneRun("BM_A", 4.0), mean, mean});
  ASSERT_TRUE(results.ok());
  EXPECT_EQ(results->Nanoseconds("BM_A").value(), 4.0);
}

TEST(MicroResults, ReportsMissingMeasurements) {
  const auto results = Parse({OneRun("BM_A", 4.0)});
  ASSERT_TRUE(results.ok());
  EXPECT_EQ(results->Nanoseconds("BM_B").status().code(), StatusCode::kNotFound);
  EXPECT_EQ(results->Counter("BM_A", "allocations").status().code(), StatusCode::kNotFound);
}

TEST(MicroResults, RejectsAFileWithAFailedBenchmark) {
  nlohmann::json failed = OneRun("BM_B", 0.0);
  failed["error_occurred"] = true;
  failed["error_message"] = "allocates";
  const Status status = Parse({OneRun("BM_A", 4.0), failed}).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.ToString().find("BM_B failed: allocates"), std::string::npos);
  EXPECT_EQ(status.where(), "here.json");
}

TEST(MicroResults, RejectsOtherFiles) {
  EXPECT_EQ(MicroResults::Parse("", "x").status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(MicroResults::Parse("{}", "x").status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(Parse({nlohmann::json{{"run_type", "iteration"}}}).status().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(MicroResults::Load("/nowhere/at/all.json").status().code(), StatusCode::kIo);
}

TEST(MicroResults, JsonHasOnlyTimesAndUserCounters) {
  const auto results = Parse({OneRun("BM_A", 4.0)});
  ASSERT_TRUE(results.ok());
  EXPECT_EQ(results->ToJson(),
            (nlohmann::json{{"BM_A", {{"cpu_ns", 4.0}, {"bytes_per_second", 400.0}}}}));
}

}  // namespace
}  // namespace furrow::bench
