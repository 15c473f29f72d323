// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::plan {

// A figure that depends on another one, as measured; x ascending.
struct Curve {
  struct Point {
    double x = 0.0;
    double y = 0.0;
  };
  std::vector<Point> points;

  // The value at x > 0: between two points linear over log(x), outside that of the nearest point.
  // Precondition: at least one point with x > 0.
  [[nodiscard]] double At(double x) const;
  // The slope of the straight line with the least squares. 0 if there are fewer than two points.
  [[nodiscard]] double Slope() const;
};

// What the work of a daemon on one core costs, in microseconds of processor time, as `bench_load`
// measures it.
struct Costs {
  std::string machine;  // what was measured, and when
  // A pose over the poses per second on the core: waiting poses are received, solved and sent
  // together, so the work per pose is less under load. For poses with kJoints packed joints,
  // kWeights weights and one subscriber.
  Curve pose_us;
  double joint_us = 0.0;       // of each further joint of a pose
  double weight_us = 0.0;      // of each further weight
  double subscriber_us = 0.0;  // of each further subscriber of a pose
  double idle_bytes = 0.0;     // memory of a daemon without subjects
  double subject_bytes = 0.0;  // memory of each subject

  static constexpr int kJoints = 51;
  static constexpr int kWeights = 37;
};

// The costs that docs/CAPACITY.md shows, from docs/performance/load.json.
[[nodiscard]] const Costs& ShippedCosts();

// Reads the load.json of `bench_load --out`. `where`: the name of the file, for messages. Errors:
// kParse (not JSON), kSchema (a curve is missing, or a point has no measurement).
[[nodiscard]] Result<Costs> ReadCosts(std::string_view json, const std::string& where);

}  // namespace furrow::plan
