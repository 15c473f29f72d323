// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/load/setting.h"

namespace furrow::bench {

// How the cost of a daemon grows with one thing.
struct Curve {
  std::string id;  // of the files
  std::string title;
  std::string axis;  // what grows, with its unit
  struct Point {
    double x = 0.0;
    load::RunResult run;
  };
  std::vector<Point> points;
};

// Each with a fresh daemon a point, on one core.
[[nodiscard]] Curve GrowSubjects(const Setting& setting);
[[nodiscard]] Curve GrowSubscribers(const Setting& setting);
[[nodiscard]] Curve GrowJoints(const Setting& setting);
[[nodiscard]] Curve GrowRegions(const Setting& setting);

// Processor time, latency and memory by x: an SVG picture; a table; and all figures.
[[nodiscard]] std::string Draw(const Curve& curve);
[[nodiscard]] std::string ToMarkdown(const Curve& curve);
[[nodiscard]] nlohmann::json ToJson(const Curve& curve);

}  // namespace furrow::bench
