// SPDX-License-Identifier: Apache-2.0
#include "client/plan/costs.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/files.h"

namespace furrow::plan {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Curve, PassesThroughItsPointsAndIsLogarithmicBetweenThem) {
  const Curve curve{{{10.0, 40.0}, {1000.0, 20.0}}};
  EXPECT_DOUBLE_EQ(curve.At(10.0), 40.0);
  EXPECT_DOUBLE_EQ(curve.At(1000.0), 20.0);
  EXPECT_DOUBLE_EQ(curve.At(100.0), 30.0) << "half way between the logarithms";
  EXPECT_DOUBLE_EQ(curve.At(1.0), 40.0);
  EXPECT_DOUBLE_EQ(curve.At(1e9), 20.0);
}

TEST(Curve, ItsSlopeIsThatOfTheLineWithTheLeastSquares) {
  const Curve line{{{1.0, 5.0}, {2.0, 7.0}, {5.0, 13.0}}};
  EXPECT_DOUBLE_EQ(line.Slope(), 2.0);
  // Deviations of opposite sign at places alike cancel out.
  const Curve scattered{{{1.0, 6.0}, {2.0, 6.0}, {3.0, 8.0}, {4.0, 12.0}}};
  EXPECT_DOUBLE_EQ(scattered.Slope(), 2.0);
  EXPECT_DOUBLE_EQ((Curve{{{1.0, 5.0}}}).Slope(), 0.0);
}

TEST(Costs, ThoseOfTheProgramAreThoseOfTheDocs) {
  const auto file = ReadFile(FURROW_LOAD_JSON, 1 << 24);
  ASSERT_TRUE(file.ok());
  const auto read = ReadCosts(*file, "load.json");
  ASSERT_TRUE(read.ok()) << read.status().ToString();
  const Costs& shipped = ShippedCosts();
  EXPECT_EQ(shipped.machine, read->machine);
  EXPECT_NEAR(shipped.joint_us, read->joint_us, 0.001);
  EXPECT_NEAR(shipped.weight_us, read->weight_us, 0.001);
  EXPECT_NEAR(shipped.subscriber_us, read->subscriber_us, 0.01);
  EXPECT_NEAR(shipped.subject_bytes, read->subject_bytes, 1.0);
  EXPECT_NEAR(shipped.idle_bytes, read->idle_bytes, 1.0);
  ASSERT_EQ(shipped.pose_us.points.size(), read->pose_us.points.size());
  for (std::size_t i = 0; i < shipped.pose_us.points.size(); ++i) {
    EXPECT_NEAR(shipped.pose_us.points[i].x, read->pose_us.points[i].x, 0.5);
    EXPECT_NEAR(shipped.pose_us.points[i].y, read->pose_us.points[i].y, 0.01);
  }
}

json CurveOf(double us_per_x) {
  json points = json::array();
  for (const double x : {1.0, 10.0, 100.0}) {
    points.push_back({{"x", x},
                      {"run",
                       {{"cpu_us_per_pose", 500.0 + us_per_x * x},
                        {"poses_per_second", 60.0 * x},
                        {"resident_bytes", 1000.0 + 7.0 * x}}}});
  }
  return {{"points", points}};
}

json File() {
  return {{"subjects", CurveOf(0.5)},
          {"subscribers", CurveOf(2.0)},
          {"joints", CurveOf(0.25)},
          {"regions", CurveOf(-1.0)}};
}

TEST(Costs, AreSlopesOfTheCurves) {
  const auto costs = ReadCosts(File().dump(), "load.json");
  ASSERT_TRUE(costs.ok()) << costs.status().ToString();
  EXPECT_NEAR(costs->subscriber_us, 2.0, 1e-9);
  EXPECT_NEAR(costs->joint_us, 0.25, 1e-9);
  EXPECT_EQ(costs->weight_us, 0.0) << "more weights do not make a pose cheaper";
  EXPECT_NEAR(costs->subject_bytes, 7.0, 1e-6);
  EXPECT_NEAR(costs->idle_bytes, 1000.0, 1e-6);
  EXPECT_DOUBLE_EQ(costs->pose_us.At(600.0), 505.0);
  EXPECT_EQ(costs->machine, "an unnamed machine");
}

TEST(Costs, RefuseFilesThatMeasureNothing) {
  const auto complaint = [](const json& file) {
    const auto costs = ReadCosts(file.dump(), "load.json");
    return costs.ok() ? std::string() : costs.status().ToString();
  };
  EXPECT_THAT(ReadCosts("{", "load.json").status().ToString(), HasSubstr("is not valid JSON"));
  EXPECT_THAT(complaint(json::array()), HasSubstr("load.json: subjects: is missing"));
  json file = File();
  file.erase("joints");
  EXPECT_THAT(complaint(file), HasSubstr("load.json: joints: is missing"));
  for (const char* path : {"/x", "/run/cpu_us_per_pose", "/run/poses_per_second", "/run"}) {
    for (const json& value : {json(-1.0), json(0), json("much"), json(nullptr), json(true)}) {
      file = File();
      file["subjects"]["points"][1][json::json_pointer(path)] = value;
      EXPECT_THAT(complaint(file), HasSubstr("subjects: has a point without")) << path << value;
    }
  }
  file = File();
  file["regions"]["points"] = json::array({file["regions"]["points"][0]});
  EXPECT_THAT(complaint(file), HasSubstr("regions: must have 2 to 1000 points"));
  file = File();
  std::swap(file["subjects"]["points"][0], file["subjects"]["points"][2]);
  EXPECT_THAT(complaint(file), HasSubstr("subjects: has a point without")) << "x must rise";
}

}  // namespace
}  // namespace furrow::plan
