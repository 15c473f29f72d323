// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/report.h"

#include <array>

#include <nlohmann/json.hpp>

#include "report/words.h"

namespace furrow::load {
namespace {

using furrow::report::Counted;

// What may befall a datagram, by an option of the same probability.
struct Fault {
  const char* option;
  const char* done;
  double ChaosOptions::*probability;
  std::uint64_t ChaosCounts::*count;
};

constexpr std::array kFaults = {
    Fault{"--loss", "lost", &ChaosOptions::loss, &ChaosCounts::lost},
    Fault{"--reorder", "reordered", &ChaosOptions::reorder, &ChaosCounts::reordered},
    Fault{"--duplicate", "duplicated", &ChaosOptions::duplicate, &ChaosCounts::duplicated},
    Fault{"--delay", "delayed", &ChaosOptions::delay, &ChaosCounts::delayed},
    Fault{"--falsify", "falsified", &ChaosOptions::falsify, &ChaosCounts::falsified},
    Fault{"--swap", "swapped", &ChaosOptions::swap, &ChaosCounts::swapped}};

bool Asked(const ChaosOptions& options, const Fault& fault) {
  return options.*fault.probability > 0.0;
}

void AddToList(const char* word, std::string* list) {
  *list += (list->empty() ? "" : ", ") + std::string(word);
}

// Whether a black hole fell on nothing at all, of those directions that have one.
bool NothingSwallowed(const ChaosOutcome& up, const ChaosOutcome& down) {
  if (up.options.black_holes.empty() && down.options.black_holes.empty()) return false;
  return up.counts.swallowed + down.counts.swallowed == 0 &&
         up.stream_counts.still_us + down.stream_counts.still_us == 0;
}

}  // namespace

std::string ToText(const std::string& way, const ChaosOutcome& outcome) {
  const ChaosCounts& counts = outcome.counts;
  std::string text = way + ": " + Counted(counts.packets, "datagram");
  for (const Fault& fault : kFaults) {
    if (Asked(outcome.options, fault))
      text += ", " + std::string(fault.done) + " " + std::to_string(counts.*fault.count);
  }
  if (!outcome.options.black_holes.empty())
    text += ", swallowed " + std::to_string(counts.swallowed);
  const ChaosStreamCounts& stream = outcome.stream_counts;
  if (stream.connections == 0) return text;
  return text + "\n" + way + " over TCP: " + Counted(stream.connections, "connection") + ", " +
         Counted(stream.bytes, "byte") + ", held back " + Counted(stream.held, "time") +
         ", stood still for " + std::to_string(stream.still_us / 1000) + " ms";
}

std::string NothingPlanted(const ChaosOutcome& up, const ChaosOutcome& down) {
  std::string options;
  for (const Fault& fault : kFaults) {
    const bool asked = Asked(up.options, fault) || Asked(down.options, fault);
    if (asked && up.counts.*fault.count + down.counts.*fault.count == 0)
      AddToList(fault.option, &options);
  }
  if (NothingSwallowed(up, down)) AddToList("--black-hole", &options);
  if (options.empty()) return {};
  return "Nothing was planted of " + options +
         ": this run says nothing about it. Let more pass, or ask for more.\n";
}

std::string DatagramFaults(const ChaosOptions& options) {
  std::string list;
  for (const Fault& fault : kFaults) {
    if (Asked(options, fault)) AddToList(fault.option, &list);
  }
  return list;
}

nlohmann::json ToJson(const ChaosOptions& options) {
  nlohmann::json holes = nlohmann::json::array();
  for (const BlackHole& hole : options.black_holes)
    holes.push_back({{"start", hole.start}, {"length", hole.length}, {"every", hole.every}});
  return {{"seed", options.seed},           {"loss", options.loss},
          {"reorder", options.reorder},     {"duplicate", options.duplicate},
          {"delay", options.delay},         {"delay_ms", options.delay_ms},
          {"jitter_ms", options.jitter_ms}, {"falsify", options.falsify},
          {"swap", options.swap},           {"black_holes", holes}};
}

nlohmann::json ToJson(const ChaosOutcome& outcome) {
  nlohmann::json json{{"datagrams", outcome.counts.packets},
                      {"swallowed", outcome.counts.swallowed},
                      {"tcp",
                       {{"connections", outcome.stream_counts.connections},
                        {"bytes", outcome.stream_counts.bytes},
                        {"held", outcome.stream_counts.held},
                        {"still_us", outcome.stream_counts.still_us}}}};
  for (const Fault& fault : kFaults) json[fault.done] = outcome.counts.*fault.count;
  return json;
}

}  // namespace furrow::load
