// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/files.h"
#include "base/status.h"
#include "client/chaos/report.h"
#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/file_output.h"
#include "client/cli/interrupt.h"
#include "client/cli/load/load_flags.h"
#include "client/cli/load/load_input.h"
#include "client/cli/load/load_settings.h"
#include "client/cli/load/own_chaos.h"
#include "client/cli/progress.h"
#include "client/load/compare/comparison_report.h"
#include "client/load/net/descriptor_limit.h"
#include "client/load/net/echo.h"
#include "client/load/report.h"
#include "client/load/verdict.h"

namespace furrow::cli {
namespace {

using client::TransportKind;
using load::Path;
using load::Target;

int FailLoad(const Status& status) {
  const int code = Fail(status);
  return status.code() == StatusCode::kUnavailable ? kNoConnection : code;
}

// The port of HOST:PORT is that of the transport asked for; the other has its own option.
bool MakeTarget(const LoadFlags& flags, Target* target) {
  const bool tcp = flags.run.path == Path::kTcp;
  Endpoint named;
  Endpoint other;
  const auto kind = tcp ? TransportKind::kTcp : TransportKind::kUdp;
  const auto other_kind = tcp ? TransportKind::kUdp : TransportKind::kTcp;
  if (!ParseEndpoint(flags.host, kind, &named)) return false;
  (void)ParseEndpoint("localhost", other_kind, &other);  // for its default port
  if (flags.other_port != 0) other.port = flags.other_port;
  target->host = named.host;
  target->udp = tcp ? other.port : named.port;
  target->tcp = tcp ? named.port : other.port;
  target->loopback =
      named.host == "localhost" || named.host.starts_with("127.") || named.host == "::1";
  if (flags.pid != 0) {
    target->pid = flags.pid;
  } else if (target->loopback) {
    target->pid = load::FindPortOwner(tcp ? "tcp" : "udp", named.port);
  }
  return true;
}

// One line that is written over, on a terminal alone.
void ShowLive(const std::string& line) {
  if (isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r\033[K%s", line.c_str());
}

void EndLive() { ShowLive(""); }

Status WriteText(const std::string& path, const std::string& text) {
  if (path.empty()) return {};
  return WriteFileAtomically(path, text);
}

// All that is to be told, as far as it came.
struct Findings {
  std::optional<load::Comparison> comparison;
  std::optional<load::RunResult> run;
  std::optional<Planted> planted;  // by chaos of our own

  [[nodiscard]] bool any() const { return comparison || run; }
};

std::string ToText(const LoadFlags& flags, const Findings& findings) {
  std::string text;
  if (findings.comparison) text += load::ToText(*findings.comparison) + "\n";
  if (findings.run) text += load::ToText(*findings.run, flags.run);
  if (!findings.planted) return text;
  const auto& [up, down] = *findings.planted;
  return text + load::ToText("Planted, up", up) + "\n" + load::ToText("Planted, down", down) +
         "\n" + load::NothingPlanted(up, down);
}

Status WriteOutputs(const LoadFlags& flags, const Findings& findings) {
  nlohmann::json json{{"settings", SettingsOf(flags)}};
  if (findings.comparison) json["comparison"] = load::ToJson(*findings.comparison);
  if (findings.run) json["run"] = load::ToJson(*findings.run);
  if (findings.planted) {
    json["planted"] = {{"up", load::ToJson(findings.planted->up)},
                       {"down", load::ToJson(findings.planted->down)}};
  }
  const load::RunResult run = findings.run.value_or(load::RunResult{});
  std::ostringstream hgrm;
  run.latency_ns.WriteHgrm(hgrm, 1e6);
  const auto steps =
      findings.comparison ? findings.comparison->steps : std::vector<load::RateStep>();
  Status status = WriteText(flags.json, json.dump(2) + "\n");
  if (status.ok()) status = WriteText(flags.hgrm, hgrm.str());
  if (status.ok()) status = WriteText(flags.plot, load::Plot(run, steps));
  return status;
}

int Print(const std::string& text) {
  const Status status =
      WriteStandardOutput({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return status.ok() ? kDone : StandardOutputFailed();
}

// Before anything is measured: what would make it useless in the end.
int CheckFlags(const LoadFlags& flags) {
  if (const std::string wrong = WrongUsage(flags); !wrong.empty()) {
    std::fprintf(stderr, "furrow: %s\n", wrong.c_str());
    return kUsage;
  }
  for (const std::string& path : {flags.json, flags.hgrm, flags.plot}) {
    if (path.empty()) continue;
    if (Status status = CheckWritable(path); !status.ok()) return Fail(status);
  }
  return kDone;
}

Status RunOnce(const LoadFlags& flags, const load::Performance& performance, Target target,
               Findings* findings) {
  load::ChaosOptions up;
  load::ChaosOptions down;
  ReadChaosFlags(flags.chaos, &up, &down);
  OwnChaos chaos;
  FURROW_RETURN_IF_ERROR(chaos.Start(up, down, &target));
  Progress progress("solving", 1000);
  Progress settling("replaying", 1000);
  const load::RunHooks hooks{
      .go_on = [] { return !Interrupted(); },
      .solving = [&](double share) { progress.Set(static_cast<std::int64_t>(1000.0 * share)); },
      .settling = [&](double share) { settling.Set(static_cast<std::int64_t>(1000.0 * share)); },
      .second =
          [](double seconds, const load::Tally& tally, const load::Histogram& latency) {
            ShowLive(load::LiveLine(seconds, tally, latency));
          }};
  auto result = load::Run(performance, target, flags.run, hooks);
  EndLive();
  findings->planted = chaos.End();
  FURROW_RETURN_IF_ERROR(result);
  findings->run = *std::move(result);
  if (findings->run->ended_early) return {StatusCode::kUnavailable, findings->run->complaint};
  return {};
}

load::ComparisonOptions OptionsOf(const LoadFlags& flags) {
  load::ComparisonOptions options = flags.comparison;
  options.run = flags.run;
  options.run.plan.seconds = std::min(flags.round_seconds, flags.run.plan.seconds);
  options.find_max = flags.find_max;
  options.p99_limit_us = flags.late_ms * 1e3;
  options.time_limit_seconds = flags.time_limit_minutes * 60.0;
  return options;
}

// --find-max and --baseline: searches and rounds.
Status RunComparison(const LoadFlags& flags, const load::Performance& performance,
                     const Target& target, Findings* findings) {
  load::Contestants contestants{.server = target, .raw = {}, .control = {}};
  std::vector<load::EchoServer> echoes;
  for (auto* echo : {&contestants.raw, &contestants.control}) {
    if (!flags.baseline) break;
    auto started = load::EchoServer::Start(target.pid);
    FURROW_RETURN_IF_ERROR(started);
    *echo = Target{
        .host = "127.0.0.1", .udp = started->port(), .tcp = 0, .echo = true, .pid = started->pid()};
    echoes.push_back(*std::move(started));
  }
  const load::RunHooks hooks{.go_on = [] { return !Interrupted(); },
                             .solving = [](double) {},
                             .settling = [](double) {},
                             .second = [](double, const load::Tally&, const load::Histogram&) {}};
  const auto run = [&](const Target& one, const load::RunOptions& options) {
    return load::Run(performance, one, options, hooks);
  };
  const auto seconds = [] { return 1e-6 * static_cast<double>(SteadyMicroseconds()); };
  findings->comparison =
      load::Compare(run, contestants, OptionsOf(flags),
                    {.go_on = hooks.go_on, .progress = ShowLive, .seconds = seconds});
  EndLive();
  return findings->comparison->failure;
}

int RunLoad(LoadFlags flags) {
  flags.run.path = flags.tcp ? Path::kTcp : flags.both ? Path::kBoth : Path::kUdp;
  flags.run.late_us = static_cast<std::int64_t>(flags.late_ms * 1e3);
  flags.run.plan.subjects = flags.subjects != 0 ? flags.subjects : flags.find_max ? 256 : 1;
  flags.run.plan.phases = 16;
  Target target;
  if (!MakeTarget(flags, &target)) {
    std::fprintf(stderr, "furrow: '%s' is not HOST, HOST:PORT or [IPV6]:PORT\n",
                 flags.host.c_str());
    return kUsage;
  }
  if (const int code = CheckFlags(flags); code != kDone) return code;
  const auto performance = LoadPerformance(flags.input);
  if (!performance.ok()) return Fail(performance.status());
  CatchInterrupts();
  load::RaiseDescriptorLimit();
  Findings findings;
  Status status;
  if (flags.find_max || flags.baseline)
    status = RunComparison(flags, *performance, target, &findings);
  if (status.ok() && !Interrupted()) status = RunOnce(flags, *performance, target, &findings);
  // What was measured is told, however it ended.
  if (findings.any()) {
    if (const int code = Print(ToText(flags, findings)); code != kDone) return code;
    if (Status written = WriteOutputs(flags, findings); !written.ok()) return Fail(written);
  }
  if (!status.ok()) return FailLoad(status);
  return flags.strict && !(findings.run && load::Clean(*findings.run)) ? kFailed : kDone;
}

}  // namespace

void AddLoad(CLI::App& app, Action& action) {
  auto options = std::make_shared<LoadFlags>();
  CLI::App* command = app.add_subcommand(
      "load", "Sends many subjects to a daemon, and measures and checks what comes back");
  AddLoadFlags(*command, *options);
  command->callback([options, &action] { action = [options] { return RunLoad(*options); }; });
}

}  // namespace furrow::cli
