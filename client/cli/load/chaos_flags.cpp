// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/chaos_flags.h"

#include <utility>

#include "client/cli/command.h"

namespace furrow::cli {

void AddChaosFlags(CLI::App& command, ChaosFlags& flags) {
  load::ChaosOptions& options = flags.options;
  const auto probability = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->check(Within(0.0, 1.0))->capture_default_str();
  };
  command
      .add_option("--seed", options.seed,
                  "What happens to the n-th packet of a link follows from it")
      ->capture_default_str();
  probability("--loss", options.loss, "Share of the datagrams that is lost");
  probability("--reorder", options.reorder, "Share that goes after the next one");
  probability("--duplicate", options.duplicate, "Share that is sent twice");
  probability("--delay", options.delay, "Share that comes --delay-by later");
  command.add_option("--delay-by", options.delay_ms, "Milliseconds")
      ->check(Within(0.0, 3.6e6))
      ->capture_default_str();
  command.add_option("--jitter", options.jitter_ms, "Each comes up to so many milliseconds later")
      ->check(Within(0.0, 3.6e6))
      ->capture_default_str();
  probability("--falsify", options.falsify,
              "Share of the poses and weights of which one number is changed");
  probability("--swap", options.swap, "Share that exchanges its content with the next of its kind");
  command
      .add_option(
          "--black-hole", flags.black_holes,
          "START:LENGTH[:EVERY], seconds since the first packet in which nothing passes (TCP "
          "stands still); may be given several times")
      ->expected(1)
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto hole = load::ParseBlackHole(text);
            return hole.ok() ? std::string() : hole.status().ToString();
          },
          ""))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const std::map<std::string, ChaosWay> ways{
      {"up", ChaosWay::kUp}, {"down", ChaosWay::kDown}, {"both", ChaosWay::kBoth}};
  AddChoice(command, "--way", flags.way, ways, "up: to the daemon; down: from it; both (default)");
}

void ReadChaosFlags(const ChaosFlags& flags, load::ChaosOptions* up, load::ChaosOptions* down) {
  load::ChaosOptions options = flags.options;
  for (const std::string& text : flags.black_holes)
    options.black_holes.push_back(*load::ParseBlackHole(text));
  *up = flags.way == ChaosWay::kDown ? load::ChaosOptions{} : options;
  *down = flags.way == ChaosWay::kUp ? load::ChaosOptions{} : options;
}

}  // namespace furrow::cli
