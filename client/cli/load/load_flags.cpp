// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_flags.h"

#include "client/chaos/report.h"
#include "client/cli/command.h"
#include "client/load/measure/process_usage.h"

namespace furrow::cli {
namespace {

void AddWhat(CLI::App& command, LoadFlags& options) {
  command
      .add_option("HOST", options.host,
                  "HOST, HOST:PORT or [IPV6]:PORT of furrowd; PORT is UDP's, or TCP's with --tcp")
      ->required();
  command
      .add_option("FILE", options.input.file,
                  "What all subjects perform: BVH, glTF/GLB, VRMA, Live Link CSV or a take (.mcap)")
      ->required();
  command
      .add_option("--subjects", options.subjects,
                  "How many send at once, each from another place of the recording; default 1, "
                  "with --find-max 256")
      ->check(CLI::Range(1, 65535));
  command
      .add_option("--rate", options.run.plan.rate,
                  "Poses a second of each subject; default: the recording's own spacing")
      ->check(Within(0.01, 100000.0));
  command.add_option("--duration", options.run.plan.seconds, "Seconds of one run")
      ->check(Within(0.01, 1e6))
      ->capture_default_str();
  auto* udp = command.add_flag("--udp", options.udp, "Poses and weights as datagrams (default)");
  auto* tcp = command.add_flag("--tcp", options.tcp, "Over TCP")->excludes(udp);
  command.add_flag("--both", options.both, "Half of the connections each")
      ->excludes(udp)
      ->excludes(tcp);
  command.add_option(
      "--other-port", options.other_port,
      "furrowd's port of the transport that HOST does not name (7400 TCP, 7401 UDP)");
  command.add_flag("--quantise", options.input.quantise, "Send packed poses, as play --quantise");
  command.add_option("--scale", options.input.scale, "Metres per unit of the recording's lengths")
      ->check(Within(1e-6, 1e6))
      ->capture_default_str();
}

void AddWho(CLI::App& command, LoadFlags& options) {
  const auto count = [&](const char* name, int& value, int least, const char* help) {
    command.add_option(name, value, help)->check(CLI::Range(least, 4096))->capture_default_str();
  };
  count("--subscribers", options.run.watchers, 1, "How many watch every subject, and are measured");
  count("--slow", options.run.burdens.slow, 0,
        "Further ones over TCP that read one message a second");
  count("--stalled", options.run.burdens.stalled, 0, "... that never read");
  count("--churn", options.run.burdens.churn, 0, "... that leave and come back all the time");
  command.add_option("--rig", options.input.rig,
                     "The daemon's wrinkle rig, by which weights are checked; default: the default "
                     "character's");
  AddSkeletonMap(command, options.input.skeleton_map);
  command.add_option("--tolerance", options.run.tolerance, "Of a weight, before it is wrong")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--late", options.late_ms,
                  "Milliseconds after which weights are late; --find-max keeps p99 below")
      ->check(Within(0.001, 1e6))
      ->capture_default_str();
  command
      .add_option("--drain", options.run.drain_seconds,
                  "Seconds without weights after which what is missing is lost")
      ->check(Within(0.0, 3600.0))
      ->capture_default_str();
  command.add_option("--pid", options.pid,
                     "The daemon's process, for CPU and memory; default: who owns the port here");
}

void AddHow(CLI::App& command, LoadFlags& options) {
  command.add_flag("--find-max", options.find_max,
                   "First search the highest rate that loses nothing and holds p99 (--late)");
  command.add_flag("--baseline", options.baseline,
                   "First run beside a raw UDP echo, in turn, and print ratios");
  command
      .add_option("--time-limit", options.time_limit_minutes,
                  "Minutes after which --find-max and --baseline begin nothing new")
      ->check(Within(0.01, 1e4))
      ->capture_default_str();
  command.add_option("--rounds", options.comparison.rounds, "Runs of each, for --baseline")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      .add_option("--round-time", options.round_seconds,
                  "Seconds of one run of a round, at most --duration")
      ->check(Within(0.05, 3600.0))
      ->capture_default_str();
  command.add_option("--searches", options.comparison.searches, "Searches of each, for --find-max")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--probe", options.comparison.probe_seconds, "Seconds of one run of a search")
      ->check(Within(0.05, 60.0))
      ->capture_default_str();
  command
      .add_option("--limit", options.comparison.search_limit,
                  "Poses a second beyond which --find-max does not search")
      ->check(Within(1.0, 1e7))
      ->capture_default_str();
  command.add_flag(
      "--strict", options.strict,
      "Exit with 1 where anything was lost, late, wrong, not checked, not sent, or cut short");
  command.add_option("--json", options.json, "Write all figures to this file");
  command.add_option("--hgrm", options.hgrm,
                     "Write the latencies (ms) in HdrHistogram's text format");
  command.add_option("--plot", options.plot,
                     "Write curves (SVG): latency by percentile, over time, by rate");
}

}  // namespace

void AddLoadFlags(CLI::App& command, LoadFlags& flags) {
  AddWhat(command, flags);
  AddWho(command, flags);
  AddHow(command, flags);
  AddChaosFlags(command, flags.chaos);
}

std::string WrongUsage(const LoadFlags& flags) {
  load::ChaosOptions up;
  load::ChaosOptions down;
  ReadChaosFlags(flags.chaos, &up, &down);
  if ((flags.find_max || flags.baseline) && (up.any() || down.any())) {
    return "--find-max and --baseline measure a network in peace: leave out --loss and the like, "
           "or "
           "load once more with them alone";
  }
  if (const std::string faults = load::DatagramFaults(flags.chaos.options);
      flags.tcp && !faults.empty()) {
    return faults +
           ": this befalls datagrams, and --tcp sends none; leave out --tcp or take --both, or "
           "plant --jitter and --black-hole, which TCP knows, too";
  }
  if (flags.pid != 0 && !load::ReadUsage(flags.pid)) {
    return "--pid " + std::to_string(flags.pid) +
           ": there is no such process on this machine; leave it out where the daemon is elsewhere";
  }
  return {};
}

}  // namespace furrow::cli
