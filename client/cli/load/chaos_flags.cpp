// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/chaos_flags.h"

#include <utility>

#include "client/cli/common/command.h"

namespace furrow::cli {

void AddChaosFlags(CLI::App& command, ChaosFlags& flags) {
  chaos::Faults& options = flags.options;
  const auto probability = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->check(Within(0.0, 1.0))->capture_default_str();
  };
  const auto milliseconds = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->check(Within(0.0, 3.6e6))->capture_default_str();
  };
  command
      .add_option("--seed", options.seed,
                  "Random seed; the same seed gives each packet number the same faults again")
      ->capture_default_str();
  probability("--loss", options.loss, "Probability that a datagram is lost");
  probability("--reorder", options.reorder,
              "Probability that a datagram is sent after the next one");
  probability("--duplicate", options.duplicate, "Probability that a datagram is sent twice");
  probability("--delay", options.delay, "Probability that a datagram is delayed by --delay-by");
  milliseconds("--delay-by", options.delay_ms, "Delay of --delay, in milliseconds");
  milliseconds("--jitter", options.jitter_ms,
               "Largest random delay of each datagram, and of TCP data, in milliseconds");
  probability("--falsify", options.falsify,
              "Probability that one number of a pose or weights message is changed");
  probability(
      "--swap", options.swap,
      "Probability that a pose or weights message swaps contents with the next of its kind");
  command
      .add_option("--black-hole", flags.black_holes,
                  "Outage START:LENGTH[:EVERY], in seconds since the first packet: datagrams are "
                  "lost and TCP stalls (repeatable; default: none)")
      ->expected(1)
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto hole = chaos::ParseBlackHole(text);
            return hole.ok() ? std::string() : hole.status().ToString();
          },
          ""))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const std::map<std::string, ChaosWay> ways{
      {"up", ChaosWay::kUp}, {"down", ChaosWay::kDown}, {"both", ChaosWay::kBoth}};
  AddChoice(command, "--way", flags.way, ways,
            "Direction of the faults: up (to the daemon), down (from the daemon) or both");
}

void ReadChaosFlags(const ChaosFlags& flags, chaos::Faults* up, chaos::Faults* down) {
  chaos::Faults options = flags.options;
  for (const std::string& text : flags.black_holes)
    options.black_holes.push_back(*chaos::ParseBlackHole(text));
  *up = flags.way == ChaosWay::kDown ? chaos::Faults{} : options;
  *down = flags.way == ChaosWay::kUp ? chaos::Faults{} : options;
}

}  // namespace furrow::cli
