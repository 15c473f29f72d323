// SPDX-License-Identifier: Apache-2.0
#include "client/plan/costs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace furrow::plan {
namespace {

using Json = nlohmann::json;

// What the points of a curve in load.json are read as.
struct Columns {
  Curve cpu;     // microseconds per pose, over x
  Curve rate;    // poses per second, over x
  Curve memory;  // bytes, over x
};

constexpr std::size_t kMaxPoints = 1000;

const char* const kTodo = "give the load.json that 'bench_load --out FOLDER' writes";

Result<Columns> ReadColumns(const Json& root, const char* name, const std::string& where) {
  const auto wrong = [&](const char* what) {
    return Status(StatusCode::kSchema, what, where + ": " + name, kTodo);
  };
  const auto curve = root.is_object() ? root.find(name) : root.end();
  if (curve == root.end() || !curve->is_object()) return wrong("is missing");
  const auto points = curve->find("points");
  if (points == curve->end() || !points->is_array()) return wrong("has no points");
  if (points->size() < 2 || points->size() > kMaxPoints) return wrong("must have 2 to 1000 points");
  Columns columns;
  for (const Json& point : *points) {
    const auto number = [&point](const char* path) {
      const Json::json_pointer pointer(path);
      const bool found = point.is_structured() && point.contains(pointer);
      return found && point.at(pointer).is_number() ? point.at(pointer).get<double>() : 0.0;
    };
    const double x = number("/x");
    const double last = columns.cpu.points.empty() ? 0.0 : columns.cpu.points.back().x;
    for (auto [values, path] : {std::pair(&columns.cpu, "/run/cpu_us_per_pose"),
                                std::pair(&columns.rate, "/run/poses_per_second"),
                                std::pair(&columns.memory, "/run/resident_bytes")}) {
      const double y = number(path);
      if (!std::isfinite(y) || y <= 0.0 || !std::isfinite(x) || x <= last) {
        return wrong("has a point without x, processor time, rate or memory");
      }
      values->points.push_back({x, y});
    }
  }
  return columns;
}

// Texts of a file are shown to people, so they are short and printable.
std::string MachineOf(const Json& root) {
  std::string text;
  const auto measured = root.find("measured");
  if (measured == root.end() || !measured->is_object()) return "an unnamed machine";
  for (const char* name : {"processor", "date"}) {
    const auto value = measured->find(name);
    if (value == measured->end() || !value->is_string()) continue;
    text += (text.empty() ? "" : ", ") + Quoted(value->get<std::string>());
  }
  return text.empty() ? "an unnamed machine" : text;
}

// No measurement makes more work cheaper; noise does.
double CostOf(const Columns& columns) { return std::max(0.0, columns.cpu.Slope()); }

Costs Combine(std::string machine, const Columns& subjects, const Columns& subscribers,
              const Columns& joints, const Columns& regions) {
  Costs costs{.machine = std::move(machine)};
  for (std::size_t i = 0; i < subjects.cpu.points.size(); ++i) {
    costs.pose_us.points.push_back({subjects.rate.points[i].y, subjects.cpu.points[i].y});
  }
  costs.subscriber_us = CostOf(subscribers);
  costs.joint_us = CostOf(joints);
  costs.weight_us = CostOf(regions);
  const Curve::Point few = subjects.memory.points.front();
  costs.subject_bytes = std::max(0.0, subjects.memory.Slope());
  costs.idle_bytes = std::max(0.0, few.y - few.x * costs.subject_bytes);
  return costs;
}

}  // namespace

double Curve::At(double x) const {
  const auto above =
      std::ranges::lower_bound(points, x, {}, [](const Point& point) { return point.x; });
  if (above == points.end()) return points.back().y;
  if (above == points.begin()) return points.front().y;
  const Point& low = *(above - 1);
  const double share = std::log(x / low.x) / std::log(above->x / low.x);
  return low.y + share * (above->y - low.y);
}

double Curve::Slope() const {
  if (points.size() < 2) return 0.0;
  const auto count = static_cast<double>(points.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (const Point& point : points) {
    mean_x += point.x / count;
    mean_y += point.y / count;
  }
  double products = 0.0, squares = 0.0;
  for (const Point& point : points) {
    products += (point.x - mean_x) * (point.y - mean_y);
    squares += (point.x - mean_x) * (point.x - mean_x);
  }
  return squares > 0.0 ? products / squares : 0.0;
}

// A test compares these numbers with the file.
const Costs& ShippedCosts() {
  static const Costs costs{.machine = "'AMD EPYC', '2026-11-21 19:46 UTC'",
                           .pose_us = {{{60.0, 199.97},
                                        {3'000.0, 34.74},
                                        {6'000.0, 26.76},
                                        {12'000.0, 26.87},
                                        {24'000.0, 17.89},
                                        {42'000.0, 12.95},
                                        {60'000.0, 11.13},
                                        {84'000.0, 9.80}}},
                           .joint_us = 0.0408,
                           .weight_us = 0.0883,
                           .subscriber_us = 3.14,
                           .idle_bytes = 14'341'191.0,
                           .subject_bytes = 7'096.8};
  return costs;
}

Result<Costs> ReadCosts(std::string_view json, const std::string& where) {
  const Json root = Json::parse(json.begin(), json.end(), nullptr, /*allow_exceptions=*/false);
  if (root.is_discarded()) return Status(StatusCode::kParse, "is not valid JSON", where, kTodo);
  const auto subjects = ReadColumns(root, "subjects", where);
  FURROW_RETURN_IF_ERROR(subjects);
  const auto subscribers = ReadColumns(root, "subscribers", where);
  FURROW_RETURN_IF_ERROR(subscribers);
  const auto joints = ReadColumns(root, "joints", where);
  FURROW_RETURN_IF_ERROR(joints);
  const auto regions = ReadColumns(root, "regions", where);
  FURROW_RETURN_IF_ERROR(regions);
  return Combine(MachineOf(root), *subjects, *subscribers, *joints, *regions);
}

}  // namespace furrow::plan
