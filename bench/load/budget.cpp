// SPDX-License-Identifier: Apache-2.0
#include "bench/load/budget.h"

#include <cmath>
#include <vector>

#include "bench/report/value_or_exit.h"
#include "client/cli/load/load_input.h"
#include "client/load/run/verdict.h"
#include "protocol/codec/codec.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::Fixed;

constexpr double kRate = 60.0;
constexpr double kMany = 10000.0;
constexpr double kUdpBytes = 28.0;  // IPv4 and UDP headers of each datagram

// Bytes on the wire for one pose, and for its weights to one subscriber.
struct WireBytes {
  double pose = 0.0;
  double weights = 0.0;
};

WireBytes Measure(const LoadSetup& setting) {
  const auto performance = ValueOrExit(cli::LoadWorkload(
      {.file = setting.recording, .rig = setting.rig, .packing = cli::Packing::kAlways}));
  protocol::WeightFrame frame;
  frame.values.resize(performance.binding->weight_names().size(), 0.5f);
  std::vector<std::uint8_t> weights;
  protocol::Encoder().Encode({.session = 1}, frame, weights);
  return {static_cast<double>(performance.messages.front().size()) + kUdpBytes,
          static_cast<double>(weights.size()) + kUdpBytes};
}

std::string Gigabits(double bytes_per_second) {
  return Fixed(bytes_per_second * 8e-9, 2) + " Gbit/s";
}

}  // namespace

std::string BudgetMarkdown(const Curve& subjects, const LoadSetup& setting) {
  const Curve::Point* few = nullptr;
  const Curve::Point* many = nullptr;
  for (const Curve::Point& point : subjects.points) {
    if (!load::IsSustained(point.run, 1e6 / kRate) || !point.run.usage || !point.run.cpu_seconds)
      continue;
    if (few == nullptr) few = &point;
    many = &point;
  }
  if (few == many) return "The budget needs two numbers of subjects without loss.\n";
  const auto core_share = [](const Curve::Point& point) {
    return *point.run.cpu_seconds / point.run.seconds;
  };
  const auto resident = [](const Curve::Point& point) {
    return static_cast<double>(point.run.usage->resident_bytes);
  };
  const double more = many->x - few->x;
  const double cores = (core_share(*many) - core_share(*few)) / more;
  const double memory = (resident(*many) - resident(*few)) / more;
  const WireBytes wire = Measure(setting);
  const report::Table table{
      "Cost of one performer and of 10,000 performers at 60 Hz",
      {"", "one", "10,000"},
      {{"largest number on one core, p99 < 16.7 ms", Fixed(many->x, 0), ""},
       {"processor", Fixed(1e6 * cores / kRate, 1) + " us per pose",
        Fixed(std::ceil(kMany * cores), 0) + " busy cores"},
       {"memory", Fixed(memory / 1024.0, 1) + " KiB",
        Fixed(kMany * memory / (1 << 30), 2) + " GiB"},
       {"poses in, packed", Fixed(wire.pose, 0) + " bytes", Gigabits(kMany * kRate * wire.pose)},
       {"weights out, one subscriber", Fixed(wire.weights, 0) + " bytes",
        Gigabits(kMany * kRate * wire.weights)}}};
  return report::ToMarkdown(table);
}

}  // namespace furrow::bench
