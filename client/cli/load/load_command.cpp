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
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/common/progress.h"
#include "client/cli/common/standard_output.h"
#include "client/cli/load/commands.h"
#include "client/cli/load/in_process_proxy.h"
#include "client/cli/load/load_flags.h"
#include "client/cli/load/load_input.h"
#include "client/cli/load/load_settings.h"
#include "client/load/compare/echo_server.h"
#include "client/load/report/comparison_report.h"
#include "client/load/report/plot.h"
#include "client/load/report/run_report.h"
#include "client/load/run/verdict.h"
#include "client/net/descriptor_limit.h"

namespace furrow::cli {
namespace {

using client::TransportKind;
using load::Path;
using load::Target;

int FailLoad(const Status& status) {
  const int code = Fail(status);
  return status.code() == StatusCode::kUnavailable ? kNoConnection : code;
}

// The address that the options state. Prints the error and returns nothing if they contradict it.
std::optional<client::Address> AddressOf(const LoadFlags& flags) {
  auto address = ParseHost(flags.host, {.udp = true, .security = flags.security});
  if (!address) return std::nullopt;
  if (!address->subjects.empty()) {
    std::fprintf(stderr, "furrow: address: the load tester names its subjects (leave it out)\n");
    return std::nullopt;
  }
  if (flags.udp && address->tls) {
    std::fprintf(stderr, "furrow: --udp: TLS needs TCP (over UDP, a token encrypts)\n");
    return std::nullopt;
  }
  return address;
}

// The transport that the options choose, or else the address.
Path PathOf(const LoadFlags& flags, const client::Address& address) {
  if (flags.both) return Path::kBoth;
  if (flags.tcp) return Path::kTcp;
  return !flags.udp && address.transport == TransportKind::kTcp ? Path::kTcp : Path::kUdp;
}

// HOST:PORT names the port of the chosen transport, with --both that of UDP unless the address
// states TCP; --other-port names the other one.
Target TargetOf(const LoadFlags& flags, const client::Address& address) {
  const bool tcp = flags.run.path == Path::kTcp ||
                   (flags.run.path == Path::kBoth && address.transport == TransportKind::kTcp);
  const client::Address nowhere;  // for the default port
  const std::uint16_t named = address.PortFor(tcp ? TransportKind::kTcp : TransportKind::kUdp);
  const std::uint16_t other =
      flags.other_port != 0 ? flags.other_port
                            : nowhere.PortFor(tcp ? TransportKind::kUdp : TransportKind::kTcp);
  const std::string& host = address.host;
  Target target{.host = host,
                .udp = tcp ? other : named,
                .tcp = tcp ? named : other,
                .loopback = host == "localhost" || host.starts_with("127.") || host == "::1"};
  if (flags.pid != 0) {
    target.pid = flags.pid;
  } else if (target.loopback) {
    target.pid = load::FindPortOwner(tcp ? "tcp" : "udp", named);
  }
  return target;
}

// Replaces the status line. Does nothing unless standard error is a terminal.
void ShowStatusLine(const std::string& line) {
  if (isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r\033[K%s", line.c_str());
}

void EraseStatusLine() { ShowStatusLine(""); }

Status WriteText(const std::string& path, const std::string& text) {
  if (path.empty()) return {};
  return WriteFileAtomically(path, text);
}

// All results, as far as the measurement got.
struct Findings {
  std::optional<load::Comparison> comparison;
  std::optional<load::RunResult> run;
  std::optional<InjectedFaults> injected;  // by the in-process proxy

  [[nodiscard]] bool any() const { return comparison || run; }
};

std::string ToText(const LoadFlags& flags, const Findings& findings) {
  std::string text;
  if (findings.comparison) text += load::ToText(*findings.comparison) + "\n";
  if (findings.run) text += load::ToText(*findings.run, flags.run);
  if (!findings.injected) return text;
  const auto& [up, down] = *findings.injected;
  return text + chaos::ToText("Injected faults, up", up) + "\n" +
         chaos::ToText("Injected faults, down", down) + "\n" + chaos::NothingInjected(up, down);
}

Status WriteOutputs(const LoadFlags& flags, const Findings& findings) {
  nlohmann::json json{{"settings", SettingsOf(flags)}};
  if (findings.comparison) json["comparison"] = load::ToJson(*findings.comparison);
  if (findings.run) json["run"] = load::ToJson(*findings.run);
  if (findings.injected) {
    json["planted"] = {{"up", chaos::ToJson(findings.injected->up)},
                       {"down", chaos::ToJson(findings.injected->down)}};
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

// Checks, before anything is measured, that the options are consistent and the outputs writable.
int CheckFlags(const LoadFlags& flags) {
  if (const std::string wrong = FindConflict(flags); !wrong.empty()) {
    std::fprintf(stderr, "furrow: %s\n", wrong.c_str());
    return kUsage;
  }
  for (const std::string& path : {flags.json, flags.hgrm, flags.plot}) {
    if (path.empty()) continue;
    if (Status status = CheckWritable(path); !status.ok()) return Fail(status);
  }
  return kDone;
}

Status RunOnce(const LoadFlags& flags, const load::Workload& workload, Target target,
               Findings* findings) {
  chaos::Faults up;
  chaos::Faults down;
  ReadChaosFlags(flags.chaos, &up, &down);
  InProcessProxy proxy;
  FURROW_RETURN_IF_ERROR(proxy.Start(up, down, &target));
  Progress progress("solving", 1000);
  Progress resolving("replaying", 1000);
  const load::RunHooks hooks{
      .keep_going = [] { return !Interrupted(); },
      .solving = [&](double share) { progress.Set(static_cast<std::int64_t>(1000.0 * share)); },
      .resolving = [&](double share) { resolving.Set(static_cast<std::int64_t>(1000.0 * share)); },
      .second =
          [](double seconds, const load::Tally& tally, const load::Histogram& latency) {
            ShowStatusLine(load::LiveLine(seconds, tally, latency));
          }};
  auto result = load::Run(workload, target, flags.run, hooks);
  EraseStatusLine();
  findings->injected = proxy.Stop();
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

// Implements --find-max and --baseline.
Status RunComparison(const LoadFlags& flags, const load::Workload& workload, const Target& target,
                     Findings* findings) {
  load::ComparisonTargets targets{.server = target, .raw = {}, .control = {}};
  std::vector<load::EchoServer> echoes;
  for (auto* echo : {&targets.raw, &targets.control}) {
    if (!flags.baseline) break;
    auto started = load::EchoServer::Start(target.pid);
    FURROW_RETURN_IF_ERROR(started);
    *echo = Target{
        .host = "127.0.0.1", .udp = started->port(), .tcp = 0, .echo = true, .pid = started->pid()};
    echoes.push_back(*std::move(started));
  }
  const load::RunHooks hooks{.keep_going = [] { return !Interrupted(); },
                             .solving = [](double) {},
                             .resolving = [](double) {},
                             .second = [](double, const load::Tally&, const load::Histogram&) {}};
  const auto run = [&](const Target& one, const load::RunOptions& options) {
    return load::Run(workload, one, options, hooks);
  };
  const auto seconds = [] { return 1e-6 * static_cast<double>(SteadyMicroseconds()); };
  findings->comparison = load::Compare(
      run, targets, OptionsOf(flags),
      {.keep_going = hooks.keep_going, .progress = ShowStatusLine, .seconds = seconds});
  EraseStatusLine();
  return findings->comparison->failure;
}

int RunLoad(LoadFlags flags) {
  const auto address = AddressOf(flags);
  if (!address) return kUsage;
  flags.run.path = PathOf(flags, *address);
  flags.tcp = flags.run.path == Path::kTcp;  // TLS implies it
  flags.security.tls = address->tls;
  flags.input.packing = PackingOf(flags);
  flags.run.late_us = static_cast<std::int64_t>(flags.late_ms * 1e3);
  flags.run.plan.subjects = flags.subjects != 0 ? flags.subjects : flags.find_max ? 256 : 1;
  flags.run.plan.phases = 16;
  Target target = TargetOf(flags, *address);
  const auto security = client::LoadSecurityOf(*address);
  if (!security.ok()) return Fail(security.status());
  target.security = *security;
  const bool in_clear =
      target.security.token && target.security.tls == nullptr && !target.security.token_in_clear;
  if (in_clear && flags.run.path != Path::kUdp && !target.loopback) {
    std::fprintf(stderr,
                 "furrow: --token: it would travel to %s unencrypted (use --udp or --tls; "
                 "--token-in-clear sends it anyway)\n",
                 target.host.c_str());
    return kUsage;
  }
  if (const int code = CheckFlags(flags); code != kDone) return code;
  const auto workload = LoadWorkload(flags.input);
  if (!workload.ok()) return Fail(workload.status());
  CatchInterrupts();
  net::RaiseDescriptorLimit();
  Findings findings;
  Status status;
  if (flags.find_max || flags.baseline) status = RunComparison(flags, *workload, target, &findings);
  if (status.ok() && !Interrupted()) status = RunOnce(flags, *workload, target, &findings);
  // Report what was measured even if an error ended the run.
  if (findings.any()) {
    if (const int code = Print(ToText(flags, findings)); code != kDone) return code;
    if (Status written = WriteOutputs(flags, findings); !written.ok()) return Fail(written);
  }
  if (!status.ok()) return FailLoad(status);
  return flags.strict && !(findings.run && load::IsClean(*findings.run)) ? kFailed : kDone;
}

}  // namespace

void AddLoad(CLI::App& app, Action& action) {
  auto options = std::make_shared<LoadFlags>();
  CLI::App* command = app.add_subcommand("load", HelpOf("load"));
  AddLoadFlags(*command, *options);
  command->callback([options, &action] { action = [options] { return RunLoad(*options); }; });
}

}  // namespace furrow::cli
