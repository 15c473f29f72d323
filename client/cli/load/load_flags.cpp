// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_flags.h"

#include "client/chaos/report.h"
#include "client/cli/common/command.h"
#include "client/load/measure/process_usage.h"

namespace furrow::cli {
namespace {

void AddTrafficOptions(CLI::App& command, LoadFlags& options) {
  command
      .add_option("HOST", options.host,
                  "Address of furrowd: HOST, HOST:PORT, [IPV6]:PORT or "
                  "furrow://HOST:PORT?KEY=VALUE; PORT is "
                  "the UDP port, or the TCP port with --tcp or TLS")
      ->required();
  command
      .add_option("FILE", options.input.file,
                  "Recording that all subjects send: BVH, glTF/GLB, VRMA, FBX, Collada, Live Link "
                  "Face CSV or a "
                  "take (.mcap)")
      ->required();
  command
      .add_option("--subjects", options.subjects,
                  "Number of subjects, each with a different start frame (default: 1; 256 with "
                  "--find-max)")
      ->check(CLI::Range(1, 65535));
  command
      .add_option("--first", options.run.first,
                  "Number in the name of the first subject, for several generators at a time "
                  "(default: 0)")
      ->check(CLI::Range(0, 900000));
  command
      .add_option("--rate", options.run.plan.rate,
                  "Poses per second for each subject (default: the rate of the recording)")
      ->check(Within(0.01, 100000.0));
  command.add_option("--duration", options.run.plan.seconds, "Length of the run, in seconds")
      ->check(Within(0.01, 1e6))
      ->capture_default_str();
  auto* step =
      command
          .add_option("--clock-step", options.run.plan.clock_step,
                      "Let the clocks of the poses jump by this time, in seconds, forwards "
                      "and backwards in turn (default: never)")
          ->check(Within(0.0, 1e6));
  command
      .add_option("--clock-every", options.run.plan.clock_every,
                  "Time between two jumps of the clocks, in seconds")
      ->check(Within(0.01, 1e6))
      ->needs(step)
      ->capture_default_str();
}

void AddTransportOptions(CLI::App& command, LoadFlags& options) {
  auto* udp = command.add_flag("--udp", options.udp, "Use UDP (default without TLS)");
  auto* tcp = command.add_flag("--tcp", options.tcp, "Use TCP")->excludes(udp);
  command.add_flag("--both", options.both, "Use UDP for half of the connections and TCP for half")
      ->excludes(udp)
      ->excludes(tcp);
  AddSecurityOptions(command, options.security);
  command.add_option(
      "--other-port", options.other_port,
      "furrowd's port for the other transport, which PORT does not give (default: 7400 for "
      "TCP, 7401 for UDP)");
}

// How poses are packed and read.
void AddPoseOptions(CLI::App& command, LoadFlags& options) {
  auto* quantise = command.add_flag("--quantise", options.quantise,
                                    "Send packed poses, as 'furrow play --quantise' does "
                                    "(default: those that do not fit one datagram)");
  command
      .add_flag("--floats", options.floats,
                "Send poses as floats, in several datagrams if necessary (default with --tcp)")
      ->excludes(quantise);
  command
      .add_flag("--redundant", options.run.redundant,
                "Repeat the previous pose in each datagram where both fit, as 'furrow play "
                "--redundant' does; implies --quantise")
      ->excludes("--floats")
      ->excludes("--clock-step")  // a repeated pose states its age, not its time
      ->excludes("--tcp");
  command.add_option("--scale", options.input.scale, "Metres per unit of the recording's lengths")
      ->check(Within(1e-6, 1e6))
      ->capture_default_str();
}

void AddSubscriberOptions(CLI::App& command, LoadFlags& options) {
  const auto count = [&](const char* name, int& value, int least, const char* help) {
    command.add_option(name, value, help)->check(CLI::Range(least, 4096))->capture_default_str();
  };
  count("--subscribers", options.run.watchers, 1,
        "Number of measured subscribers; each receives all subjects");
  count("--slow", options.run.misbehavior.slow, 0,
        "Number of extra TCP subscribers that read one message per second");
  count("--stalled", options.run.misbehavior.stalled, 0,
        "Number of extra TCP subscribers that never read");
  count("--churn", options.run.misbehavior.churn, 0,
        "Number of extra TCP subscribers that connect and disconnect for half a second each, in "
        "turn");
  command.add_option("--rig", options.input.rig,
                     "The daemon's wrinkle rig or its character (.glb), by file or shipped name, "
                     "to check the weights (default: the default character's rig)");
  AddReadOptions(command, options.input.read);
  AddSkeletonMap(command, options.input.skeleton_map);
  AddShapeMap(command, options.input.shape_map);
  command
      .add_option("--tolerance", options.run.tolerance,
                  "Largest accepted error of a weight, which is in [0, 1]")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option(
          "--late", options.late_ms,
          "Latency above which a weight message counts as late, in milliseconds; also the limit "
          "on p99 for --find-max")
      ->check(Within(0.001, 1e6))
      ->capture_default_str();
  command
      .add_option("--drain", options.run.drain_seconds,
                  "Time without weights after which missing weights count as lost, in seconds")
      ->check(Within(0.0, 3600.0))
      ->capture_default_str();
  command.add_option(
      "--pid", options.pid,
      "Process ID of the daemon, for CPU time and memory (default: the local process "
      "that owns the port)");
}

void AddComparisonOptions(CLI::App& command, LoadFlags& options) {
  command.add_flag("--find-max", options.find_max,
                   "First search the highest rate without loss and with p99 below --late");
  command.add_flag("--baseline", options.baseline,
                   "First compare the daemon with a raw UDP echo and print ratios");
  command
      .add_option("--time-limit", options.time_limit_minutes,
                  "Time after which --find-max and --baseline start no new run, in minutes")
      ->check(Within(0.01, 1e4))
      ->capture_default_str();
  command
      .add_option("--rounds", options.comparison.rounds, "Number of runs per server for --baseline")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      .add_option("--round-time", options.round_seconds,
                  "Length of one run of a round, in seconds, limited to --duration")
      ->check(Within(0.05, 3600.0))
      ->capture_default_str();
  command
      .add_option("--searches", options.comparison.searches,
                  "Number of searches per server for --find-max")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command
      .add_option("--probe", options.comparison.probe_seconds,
                  "Length of one run of a search, in seconds")
      ->check(Within(0.05, 60.0))
      ->capture_default_str();
  command
      .add_option("--limit", options.comparison.search_limit,
                  "Highest rate that --find-max tries, in poses per second")
      ->check(Within(1.0, 1e7))
      ->capture_default_str();
}

void AddOutputOptions(CLI::App& command, LoadFlags& options) {
  command.add_flag(
      "--strict", options.strict,
      "Exit with 1 if anything was lost, late, wrong, unchecked, not sent or cut short");
  command.add_option("--json", options.json, "Write all figures to this JSON file (default: none)");
  command.add_option("--hgrm", options.hgrm,
                     "Write the latencies, in milliseconds, to this file in HdrHistogram's text "
                     "format (default: none)");
  command.add_option(
      "--plot", options.plot,
      "Write charts of the latency to this SVG file: by percentile, over time and by "
      "rate (default: none)");
}

}  // namespace

void AddLoadFlags(CLI::App& command, LoadFlags& flags) {
  AddTrafficOptions(command, flags);
  AddTransportOptions(command, flags);
  AddPoseOptions(command, flags);
  AddSubscriberOptions(command, flags);
  AddComparisonOptions(command, flags);
  AddOutputOptions(command, flags);
  AddChaosFlags(command, flags.chaos);
}

Packing PackingOf(const LoadFlags& flags) {
  if (flags.quantise || flags.run.redundant) return Packing::kAlways;
  return flags.floats || flags.tcp ? Packing::kNever : Packing::kToFit;
}

std::string FindConflict(const LoadFlags& flags) {
  chaos::Faults up;
  chaos::Faults down;
  ReadChaosFlags(flags.chaos, &up, &down);
  if ((flags.find_max || flags.baseline) && (up.any() || down.any())) {
    return "--find-max and --baseline need a network without injected faults; leave out --loss and "
           "the other fault options, or run 'furrow load' again with those alone";
  }
  if (const std::string faults = chaos::DatagramFaults(flags.chaos.options);
      flags.tcp && !faults.empty()) {
    return faults +
           ": applies to datagrams only, and --tcp sends none; leave out --tcp, use --both, or use "
           "--jitter and --black-hole, which also apply to TCP";
  }
  if (flags.pid != 0 && !load::ReadUsage(flags.pid)) {
    return "--pid " + std::to_string(flags.pid) +
           ": no such process on this machine; leave out --pid if the daemon runs elsewhere";
  }
  return {};
}

}  // namespace furrow::cli
