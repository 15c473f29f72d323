// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/report.h"

#include <array>

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace furrow::chaos {
namespace {

using furrow::Counted;

// One kind of datagram fault, with its option and its fields.
struct Fault {
  const char* option;
  const char* done;
  // Pointers to members, so that one list serves text, JSON and the check below.
  double Faults::*probability;
  std::uint64_t FaultCounts::*count;
  // Those among them that carried poses or weights; null: the fault strikes nothing else, or the
  // count is not kept.
  std::uint64_t FaultCounts::*data = nullptr;
};

constexpr std::array kFaults = {
    Fault{"--loss", "lost", &Faults::loss, &FaultCounts::lost, &FaultCounts::lost_data},
    Fault{"--reorder", "reordered", &Faults::reorder, &FaultCounts::reordered},
    Fault{"--duplicate", "duplicated", &Faults::duplicate, &FaultCounts::duplicated},
    Fault{"--delay", "delayed", &Faults::delay, &FaultCounts::delayed, &FaultCounts::delayed_data},
    Fault{"--falsify", "falsified", &Faults::falsify, &FaultCounts::falsified},
    Fault{"--swap", "swapped", &Faults::swap, &FaultCounts::swapped}};

bool Asked(const Faults& options, const Fault& fault) { return options.*fault.probability > 0.0; }

void AddToList(const char* word, std::string* list) {
  *list += (list->empty() ? "" : ", ") + std::string(word);
}

// True if black holes were requested but affected neither datagrams nor TCP connections.
bool NothingSwallowed(const Outcome& up, const Outcome& down) {
  if (up.options.black_holes.empty() && down.options.black_holes.empty()) return false;
  return up.counts.swallowed + down.counts.swallowed == 0 &&
         up.stream_counts.still_us + down.stream_counts.still_us == 0;
}

}  // namespace

std::string ToText(const std::string& direction, const Outcome& outcome) {
  const FaultCounts& counts = outcome.counts;
  std::string text = direction + ": " + Counted(counts.packets, "datagram");
  for (const Fault& fault : kFaults) {
    if (!Asked(outcome.options, fault)) continue;
    text += ", " + std::string(fault.done) + " " + std::to_string(counts.*fault.count);
    if (fault.data)
      text += " (" + std::to_string(counts.*fault.data) + " with readable poses or weights)";
  }
  if (!outcome.options.black_holes.empty())
    text += ", swallowed " + std::to_string(counts.swallowed);
  const RelayCounts& stream = outcome.stream_counts;
  if (stream.connections == 0) return text;
  return text + "\n" + direction + " over TCP: " + Counted(stream.connections, "connection") +
         ", " + Counted(stream.bytes, "byte") + ", held back " + Counted(stream.held, "time") +
         ", stalled for " + std::to_string(stream.still_us / 1000) + " ms";
}

// A fault that never struck makes a test pass without having tested anything.
std::string NothingInjected(const Outcome& up, const Outcome& down) {
  std::string options;
  for (const Fault& fault : kFaults) {
    const bool asked = Asked(up.options, fault) || Asked(down.options, fault);
    if (asked && up.counts.*fault.count + down.counts.*fault.count == 0)
      AddToList(fault.option, &options);
  }
  if (NothingSwallowed(up, down)) AddToList("--black-hole", &options);
  if (options.empty()) return {};
  return "No fault was injected for " + options +
         ", so this run does not test it. Send more packets or raise the value.\n";
}

std::string DatagramFaults(const Faults& options) {
  std::string list;
  for (const Fault& fault : kFaults) {
    if (Asked(options, fault)) AddToList(fault.option, &list);
  }
  return list;
}

nlohmann::json ToJson(const Faults& options) {
  nlohmann::json holes = nlohmann::json::array();
  for (const BlackHole& hole : options.black_holes)
    holes.push_back({{"start", hole.start}, {"length", hole.length}, {"every", hole.every}});
  return {{"seed", options.seed},           {"loss", options.loss},
          {"reorder", options.reorder},     {"duplicate", options.duplicate},
          {"delay", options.delay},         {"delay_ms", options.delay_ms},
          {"jitter_ms", options.jitter_ms}, {"falsify", options.falsify},
          {"swap", options.swap},           {"black_holes", holes}};
}

nlohmann::json ToJson(const Outcome& outcome) {
  nlohmann::json json{{"datagrams", outcome.counts.packets},
                      {"swallowed", outcome.counts.swallowed},
                      {"tcp",
                       {{"connections", outcome.stream_counts.connections},
                        {"bytes", outcome.stream_counts.bytes},
                        {"held", outcome.stream_counts.held},
                        {"still_us", outcome.stream_counts.still_us}}}};
  for (const Fault& fault : kFaults) {
    json[fault.done] = outcome.counts.*fault.count;
    if (fault.data) json[std::string(fault.done) + "_data"] = outcome.counts.*fault.data;
  }
  return json;
}

}  // namespace furrow::chaos
