// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdio>
#include <memory>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "client/cli/chaos_flags.h"
#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/file_output.h"
#include "client/cli/interrupt.h"
#include "client/cli/load_input.h"
#include "client/cli/progress.h"
#include "client/load/chaos_proxy.h"
#include "client/load/comparison.h"
#include "client/load/echo.h"
#include "client/load/report.h"
#include "client/load/run.h"
#include "client/load/verdict.h"

namespace furrow::cli {
namespace {

using client::TransportKind;
using load::Path;
using load::Target;

struct LoadCommand {
  std::string host;
  LoadInput input;
  load::RunOptions run;
  int subjects = 0;  // 0: 1, or 256 for --find-max
  bool udp = false;  // the default: said for clarity
  bool tcp = false;
  bool both = false;
  std::uint16_t other_port = 0;
  double late_ms = 1000.0 / 60.0;
  int pid = 0;
  bool find_max = false;
  bool baseline = false;
  bool strict = false;
  load::ComparisonOptions comparison;
  ChaosFlags chaos;
  std::string json;
  std::string hgrm;
  std::string plot;
};

int FailLoad(const Status& status) {
  const int code = Fail(status);
  return status.code() == StatusCode::kUnavailable ? kNoConnection : code;
}

// The port of HOST:PORT is that of the transport asked for; the other has its own option.
bool MakeTarget(const LoadCommand& command, Target* target) {
  const bool tcp = command.run.path == Path::kTcp;
  Endpoint named;
  Endpoint other;
  const auto kind = tcp ? TransportKind::kTcp : TransportKind::kUdp;
  const auto other_kind = tcp ? TransportKind::kUdp : TransportKind::kTcp;
  if (!ParseEndpoint(command.host, kind, &named)) return false;
  (void)ParseEndpoint("localhost", other_kind, &other);  // for its default port
  if (command.other_port != 0) other.port = command.other_port;
  target->host = named.host;
  target->udp = tcp ? other.port : named.port;
  target->tcp = tcp ? named.port : other.port;
  const bool local =
      named.host == "localhost" || named.host.starts_with("127.") || named.host == "::1";
  if (command.pid != 0) {
    target->pid = command.pid;
  } else if (local) {
    target->pid = load::FindPortOwner(tcp ? "tcp" : "udp", named.port);
  }
  return true;
}

// A proxy between this program and the daemon, on a thread of its own while it lives.
class OwnChaos {
 public:
  // Turns `target` to the proxy where the flags ask for chaos.
  Status Start(const ChaosFlags& flags, Target* target) {
    load::ChaosProxyOptions options{.to_host = target->host,
                                    .to_udp = target->udp,
                                    .to_tcp = target->tcp,
                                    .up = {},
                                    .down = {}};
    ReadChaosFlags(flags, &options.up, &options.down);
    if (!options.up.any() && !options.down.any()) return {};
    auto proxy = load::ChaosProxy::Open(options);
    if (!proxy.ok()) return proxy.status();
    proxy_ = *std::move(proxy);
    target->host = options.listen_host;
    target->udp = proxy_->udp_port();
    target->tcp = proxy_->tcp_port();
    thread_ = std::thread([this] { proxy_->Run([this] { return !ended_.load(); }); });
    return {};
  }
  ~OwnChaos() { (void)End(); }

  // What was done; empty without chaos.
  std::string End() {
    ended_.store(true);
    if (!thread_.joinable()) return {};
    thread_.join();
    return "Planted, " + Describe("up", proxy_->up_counts()) + "\nPlanted, " +
           Describe("down", proxy_->down_counts()) + "\n";
  }

 private:
  std::unique_ptr<load::ChaosProxy> proxy_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

// One line that is written over, on a terminal alone.
void ShowLive(const std::string& line) {
  if (isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r\033[K%s", line.c_str());
}

void EndLive() { ShowLive(""); }

Status WriteText(const std::string& path, const std::string& text) {
  if (path.empty()) return {};
  return WriteFile(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

int WriteOutputs(const LoadCommand& command, const load::RunResult& result,
                 const std::vector<load::RateStep>& steps, const nlohmann::json& json) {
  std::ostringstream hgrm;
  result.latency_ns.WriteHgrm(hgrm, 1e6);
  Status status = WriteText(command.json, json.dump(2) + "\n");
  if (status.ok()) status = WriteText(command.hgrm, hgrm.str());
  if (status.ok()) status = WriteText(command.plot, load::Plot(result, steps));
  return status.ok() ? kDone : Fail(status);
}

int Print(const std::string& text) {
  const Status status =
      WriteStandardOutput({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return status.ok() ? kDone : StandardOutputFailed();
}

Result<load::RunResult> RunOnce(const LoadCommand& command, const load::Performance& performance,
                                const Target& target) {
  Progress progress("solving", 1000);
  const load::RunHooks hooks{
      .go_on = [] { return !Interrupted(); },
      .solving = [&](double share) { progress.Set(static_cast<std::int64_t>(1000.0 * share)); },
      .second =
          [](double seconds, const load::Tally& tally, const load::Histogram& latency) {
            ShowLive(load::LiveLine(seconds, tally, latency));
          }};
  auto result = load::Run(performance, target, command.run, hooks);
  EndLive();
  return result;
}

// --find-max and --baseline: searches and rounds, then nothing is left to draw but their steps.
Result<load::Comparison> RunComparison(const LoadCommand& command,
                                       const load::Performance& performance, const Target& target) {
  load::Contestants contestants{.server = target, .raw = {}, .control = {}};
  std::vector<load::EchoServer> echoes;
  for (auto* echo : {&contestants.raw, &contestants.control}) {
    if (!command.baseline) break;
    auto started = load::EchoServer::Start(target.pid);
    if (!started.ok()) return started.status();
    *echo = Target{
        .host = "127.0.0.1", .udp = started->port(), .tcp = 0, .echo = true, .pid = started->pid()};
    echoes.push_back(*std::move(started));
  }
  load::ComparisonOptions options = command.comparison;
  options.run = command.run;
  options.find_max = command.find_max;
  options.p99_limit_us = command.late_ms * 1e3;
  auto comparison = load::Compare(performance, contestants, options,
                                  {.go_on = [] { return !Interrupted(); }, .progress = ShowLive});
  EndLive();
  return comparison;
}

int RunLoad(LoadCommand command) {
  command.run.path = command.tcp ? Path::kTcp : command.both ? Path::kBoth : Path::kUdp;
  command.run.late_us = static_cast<std::int64_t>(command.late_ms * 1e3);
  command.run.plan.subjects = command.subjects != 0 ? command.subjects : command.find_max ? 256 : 1;
  command.run.plan.phases = 16;
  Target target;
  if (!MakeTarget(command, &target)) {
    std::fprintf(stderr, "furrow: '%s' is not HOST, HOST:PORT or [IPV6]:PORT\n",
                 command.host.c_str());
    return kUsage;
  }
  const auto performance = LoadPerformance(command.input);
  if (!performance.ok()) return Fail(performance.status());
  CatchInterrupts();
  nlohmann::json json;
  std::string text;
  std::vector<load::RateStep> steps;
  if (command.find_max || command.baseline) {
    const auto comparison = RunComparison(command, *performance, target);
    if (!comparison.ok()) return FailLoad(comparison.status());
    text = load::ToText(*comparison) + "\n";
    json["comparison"] = load::ToJson(*comparison);
    steps = comparison->steps;
    if (Interrupted()) return Print(text);
  }
  OwnChaos chaos;
  if (Status status = chaos.Start(command.chaos, &target); !status.ok()) return FailLoad(status);
  const auto result = RunOnce(command, *performance, target);
  if (!result.ok()) return FailLoad(result.status());
  text += load::ToText(*result, command.run) + chaos.End();
  json["run"] = load::ToJson(*result);
  if (const int code = Print(text); code != kDone) return code;
  if (const int code = WriteOutputs(command, *result, steps, json); code != kDone) return code;
  if (result->ended_early) return kNoConnection;
  return command.strict && !load::Clean(*result) ? kFailed : kDone;
}

void AddWhat(CLI::App& command, LoadCommand& options) {
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
      ->check(CLI::Range(0.01, 100000.0));
  command.add_option("--duration", options.run.plan.seconds, "Seconds of one run")
      ->check(CLI::Range(0.01, 1e6))
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
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
}

void AddWho(CLI::App& command, LoadCommand& options) {
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
      ->check(CLI::Range(0.0f, 1.0f))
      ->capture_default_str();
  command
      .add_option("--late", options.late_ms,
                  "Milliseconds after which weights are late; --find-max keeps p99 below")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  command
      .add_option("--drain", options.run.drain_seconds,
                  "Seconds without weights after which what is missing is lost")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command.add_option("--pid", options.pid,
                     "The daemon's process, for CPU and memory; default: who owns the port here");
}

void AddHow(CLI::App& command, LoadCommand& options) {
  command.add_flag("--find-max", options.find_max,
                   "First search the highest rate that loses nothing and holds p99 (--late)");
  command.add_flag("--baseline", options.baseline,
                   "First run beside a raw UDP echo, in turn, and print ratios");
  command.add_option("--rounds", options.comparison.rounds, "Runs of each, for --baseline")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--searches", options.comparison.searches, "Searches of each, for --find-max")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--probe", options.comparison.probe_seconds, "Seconds of one run of a search")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  command
      .add_option("--limit", options.comparison.search_limit,
                  "Poses a second beyond which --find-max does not search")
      ->check(CLI::Range(1.0, 1e7))
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

void AddLoad(CLI::App& app, Action& action) {
  auto options = std::make_shared<LoadCommand>();
  CLI::App* command = app.add_subcommand(
      "load", "Sends many subjects to a daemon, and measures and checks what comes back");
  AddWhat(*command, *options);
  AddWho(*command, *options);
  AddHow(*command, *options);
  AddChaosFlags(*command, options->chaos);
  command->callback([options, &action] { action = [options] { return RunLoad(*options); }; });
}

}  // namespace furrow::cli
