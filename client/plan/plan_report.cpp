// SPDX-License-Identifier: Apache-2.0
#include "client/plan/plan_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "report/table.h"

namespace furrow::plan {
namespace {

using report::Fixed;

// "1,234,567"
std::string Grouped(double value) {
  std::string text = Fixed(std::round(value), 0);
  for (auto i = static_cast<int>(text.size()) - 3; i > 0; i -= 3) {
    text.insert(static_cast<std::size_t>(i), ",");
  }
  return text;
}

// With a decimal below ten, where it matters.
std::string Rounded(double value) { return value < 10.0 ? Fixed(value, 1) : Grouped(value); }

std::string BitRate(double bits) {
  if (bits < 1e6) return Fixed(bits * 1e-3, 0) + " kbit/s";
  if (bits < 1e9) return Fixed(bits * 1e-6, 1) + " Mbit/s";
  return Fixed(bits * 1e-9, 2) + " Gbit/s";
}

std::string Memory(double bytes) {
  if (bytes < 1024.0 * 1024.0) return Fixed(bytes / 1024.0, 1) + " KiB";
  if (bytes < std::pow(1024.0, 3)) return Fixed(bytes / std::pow(1024.0, 2), 1) + " MiB";
  return Fixed(bytes / std::pow(1024.0, 3), 1) + " GiB";
}

std::string Percent(double share) { return Fixed(100.0 * share, 0) + "%"; }

std::string Number(double count, const std::string& one, const std::string& many = {}) {
  return Grouped(count) + " " + (count == 1.0 ? one : many.empty() ? one + "s" : many);
}

std::string SizeText(const MessageSize& size) {
  return Grouped(size.bytes) + " bytes, " + Number(size.datagrams, "datagram");
}

std::string Title(const Demand& demand) {
  std::string text = Number(demand.performers, "performer") + ": " +
                     Number(demand.joints, "joint") + ", " +
                     (demand.blend_shapes > 0 ? Number(demand.blend_shapes, "blend shape") + ", "
                                              : std::string()) +
                     Number(demand.weights, "weight") + ", " + Rounded(demand.rate) + " Hz, " +
                     Number(demand.subscribers, "subscriber") + " each";
  if (demand.is_sealed) text += ", sealed";
  return text;
}

std::string TrafficTable(const Capacity& plan, const Demand& demand, const Machine& machine,
                         const Costs& costs) {
  report::Table table{
      Title(demand),
      {"", "one", "all"},
      {{"poses in", SizeText(plan.pose), Grouped(plan.poses) + "/s, " + BitRate(plan.bits_in)},
       {"weights out", SizeText(plan.weights),
        Grouped(plan.messages_out) + "/s, " +
            BitRate(8.0 * plan.weights.bytes * plan.messages_out)},
       {"processor", Fixed(plan.pose_us, 1) + " us per pose",
        Fixed(plan.busy_cores, plan.busy_cores < 10.0 ? 2 : 0) + " busy cores; " +
            Number(plan.cores, "core") + " at " + Percent(machine.load)},
       {"memory without pictures", Memory(costs.subject_bytes), Memory(plan.bytes)}}};
  return report::ToMarkdown(table);
}

std::string MachineTable(const Capacity& plan, const Machine& machine) {
  const report::Table table{
      "A machine with " + Number(machine.cores, "core") + " and " + Rounded(machine.gigabits) +
          " Gbit/s, each used to " + Percent(machine.load),
      {"limited by", "performers"},
      {{"processor", Grouped(plan.by_processor)}, {"network", Grouped(plan.by_network)}}};
  return report::ToMarkdown(table);
}

std::string MachineSentence(const Capacity& plan, const Machine& machine) {
  if (plan.machines == 0.0) {
    return "Such a machine does not serve one performer.\n";
  }
  const char* limit = plan.by_network < plan.by_processor ? "the network" : "the processor";
  std::string text = Number(plan.machines, "machine") +
                     (plan.machines == 1.0 ? " serves them" : " serve them") + "; " + limit +
                     " is the limit.";
  if (machine.spares > 0) {
    text += " With " + Number(machine.spares, "spare") + ": " +
            Number(plan.machines + machine.spares, "machine") + ".";
  }
  return text + "\n";
}

std::string PictureTable(const Capacity& plan, const Demand& demand) {
  const report::Table table{
      Number(demand.viewers, "viewer") + " of pictures: " + std::to_string(demand.width) + "x" +
          std::to_string(demand.height) + ", " + Rounded(demand.picture_rate) + " Hz, skin shading",
      {"", "all"},
      {{"drawn by GPUs", Fixed(plan.gpus, 1) + " of the kind of NVIDIA H100, and " +
                             Fixed(plan.encoding_cores, 1) + " cores for H.264"},
       {"drawn by processors", Fixed(plan.picture_cores, 1) + " cores"},
       {"pictures out", BitRate(plan.bits_out - 8.0 * plan.weights.bytes * plan.messages_out)}}};
  return report::ToMarkdown(table);
}

}  // namespace

std::string ToText(const Capacity& plan, const Demand& demand, const Machine& machine,
                   const Costs& costs) {
  std::string text = TrafficTable(plan, demand, machine, costs) + "\n" +
                     MachineTable(plan, machine) + "\n" + MachineSentence(plan, machine);
  if (demand.viewers > 0.0) text += "\n" + PictureTable(plan, demand);
  if (plan.pose.datagrams > 1) {
    text +=
        "\nA pose does not fit one datagram. Each of its fragments can be lost, and the pose with "
        "it.\n";
  }
  return text + "\nMeasured: " + costs.machine +
         ". Another machine differs: measure yours with bench_load, and give its load.json to "
         "--costs.\n";
}

nlohmann::json ToJson(const Capacity& plan, const Demand& demand, const Machine& machine) {
  return {{"performers", demand.performers},
          {"poses_per_second", plan.poses},
          {"weights_per_second", plan.messages_out},
          {"pose_bytes", plan.pose.bytes},
          {"pose_datagrams", plan.pose.datagrams},
          {"weights_bytes", plan.weights.bytes},
          {"bits_in_per_second", plan.bits_in},
          {"bits_out_per_second", plan.bits_out},
          {"us_per_pose", plan.pose_us},
          {"busy_cores", plan.busy_cores},
          {"cores", plan.cores},
          {"memory_bytes", plan.bytes},
          {"performers_by_processor", plan.by_processor},
          {"performers_by_network", plan.by_network},
          {"machines", plan.machines},
          {"spares", machine.spares},
          {"gpus", plan.gpus},
          {"encoding_cores", plan.encoding_cores},
          {"picture_cores", plan.picture_cores}};
}

}  // namespace furrow::plan
