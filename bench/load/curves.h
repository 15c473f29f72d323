// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/load/load_setup.h"

namespace furrow::bench {

// The cost of a daemon as a function of one quantity.
struct Curve {
  std::string id;  // of the files
  std::string title;
  std::string axis;  // the quantity, with its unit
  struct Point {
    double x = 0.0;
    load::RunResult run;
  };
  std::vector<Point> points;
};

// Measure a curve, with a new daemon on one core for each point.
[[nodiscard]] Curve GrowSubjects(const LoadSetup& setting);
[[nodiscard]] Curve GrowSubscribers(const LoadSetup& setting);
[[nodiscard]] Curve GrowJoints(const LoadSetup& setting);
[[nodiscard]] Curve GrowRegions(const LoadSetup& setting);

// Processor time, latency and memory over x as an SVG picture, as a table, and as JSON.
[[nodiscard]] std::string Draw(const Curve& curve);
[[nodiscard]] std::string ToMarkdown(const Curve& curve);
[[nodiscard]] nlohmann::json ToJson(const Curve& curve);

}  // namespace furrow::bench
