// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "client/cli/commands/commands.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/common/progress.h"
#include "client/cpp/operate/drain_watch.h"
#include "client/cpp/operate/drainer.h"

namespace furrow::cli {
namespace {

using client::IoStatus;
using Verdict = client::DrainWatch::Verdict;

struct DrainOptions {
  std::string host;
  SecurityFlags security;
  bool tcp = false;  // the default
  bool udp = false;
  std::string wait;  // the value of --wait
  bool waits = false;
  double wait_seconds = 0.0;  // 0: without limit
};

std::string Listed(const protocol::DrainState& state) {
  std::string text;
  for (const std::string& name : state.names) text += (text.empty() ? "'" : ", '") + name + "'";
  if (state.left > state.names.size()) {
    text += " and " + std::to_string(state.left - state.names.size()) + " more";
  }
  return text;
}

std::string Count(std::uint32_t subjects) {
  return std::to_string(subjects) + (subjects == 1 ? " subject" : " subjects");
}

// " (no other node has room)", or nothing. The daemon names the subject that its reason is about.
std::string Reason(const protocol::DrainState& state) {
  if (state.why.empty()) return {};
  std::string why = state.why;
  if (state.names.size() == 1) {
    const std::string prefix = "'" + state.names[0] + "': ";
    if (why.starts_with(prefix)) why.erase(0, prefix.size());
  }
  return " (" + why + ")";
}

int FailLeft(const protocol::DrainState& state, const char* when, ExitCode code = kFailed) {
  std::fprintf(stderr, "furrow: %s; %s did not move: %s%s\n", when, Count(state.left).c_str(),
               Listed(state).c_str(), Reason(state).c_str());
  return code;
}

// What the end of the connection means. The daemon shows that it is empty before it ends.
int OnEnd(const client::Drainer& drainer) {
  const auto& state = drainer.state();
  if (!state) {
    std::fprintf(stderr, "furrow: the daemon closed the connection before it answered\n");
    return kNoConnection;
  }
  if (state->left > 0) return FailLeft(*state, "the daemon ended");
  std::printf("drained: %s moved\n", Count(state->moved).c_str());
  return kDone;
}

void Show(const protocol::DrainState& state, std::unique_ptr<Progress>* progress) {
  const auto total = static_cast<std::int64_t>(state.moved) + state.left;
  if (!*progress) *progress = std::make_unique<Progress>("moved", total);
  (*progress)->Set(std::min<std::int64_t>(state.moved, total));
}

int Conclude(Verdict verdict, const client::Drainer& drainer) {
  const auto& state = drainer.state();
  switch (verdict) {
    case Verdict::kNoAnswer:
      std::fprintf(stderr, "furrow: the daemon does not answer\n");
      return kNoConnection;
    case Verdict::kAgreed:
      std::printf("drains: %s left\n", Count(state->left).c_str());
      return kDone;
    case Verdict::kSilent: return FailLeft(*state, "the daemon no longer answers", kNoConnection);
    case Verdict::kTimedOut: return FailLeft(*state, "timed out");
    case Verdict::kEmpty:
    case Verdict::kGoesOn: break;
  }
  return OnEnd(drainer);
}

int Follow(client::Drainer& drainer, const DrainOptions& options) {
  CatchInterrupts();
  const client::DrainWatch watch(client::SteadyMicroseconds(), options.waits,
                                 static_cast<std::int64_t>(options.wait_seconds * 1e6));
  std::unique_ptr<Progress> progress;
  while (!Interrupted()) {
    const IoStatus status =
        drainer.Poll(client::SteadyMicroseconds(), std::chrono::milliseconds(20));
    if (!drainer.refusal().empty()) {
      std::fprintf(stderr, "furrow: %s\n", drainer.refusal().c_str());
      return kFailed;
    }
    if (status != IoStatus::kOk && status != IoStatus::kTimeout) return OnEnd(drainer);
    const Verdict verdict =
        watch.Judge(drainer.state(), drainer.heard_us(), client::SteadyMicroseconds());
    if (drainer.state() && options.waits) Show(*drainer.state(), &progress);
    if (verdict == Verdict::kGoesOn) continue;
    progress.reset();
    return Conclude(verdict, drainer);
  }
  return kFailed;
}

// The value of --wait may be left out, and then the address looks like it.
void TellAddressFromWait(DrainOptions* options) {
  const char* const end = options->wait.data() + options->wait.size();
  const auto [parsed, error] = std::from_chars(options->wait.data(), end, options->wait_seconds);
  const bool is_number = error == std::errc() && parsed == end;
  if (!is_number && options->host.empty()) options->host = std::exchange(options->wait, {});
  if (options->host.empty()) throw CLI::RequiredError("host");
  if (options->wait.empty()) return;
  if (!is_number || !(options->wait_seconds > 0.0 && options->wait_seconds <= 86400.0)) {
    throw CLI::ValidationError(
        "--wait", "'" + options->wait + "' is not a number above 0, and at most 86400");
  }
}

int Drain(const DrainOptions& options) {
  const auto address = ParseHost(options.host, {.udp = !options.tcp, .security = options.security});
  if (!address) return kUsage;
  const auto kind = ChooseTransport(options.udp, options.tcp, *address);
  int exit_code = kDone;
  auto transport = OpenTransport(*address, kind, /*once=*/true, &exit_code);
  if (!transport) return exit_code;
  client::Drainer drainer(std::move(transport), "furrow drain " FURROW_VERSION);
  return Follow(drainer, options);
}

}  // namespace

void AddDrain(CLI::App& app, Action& action) {
  auto options = std::make_shared<DrainOptions>();
  CLI::App* command = app.add_subcommand(
      "drain", "Move all subjects of a daemon to others of its cluster, then end the daemon");
  command->add_option("host", options->host, kHostHelp);
  auto* wait = command
                   ->add_option("--wait", options->wait,
                                "Wait until the last subject has moved, for at most these "
                                "seconds (default: no limit)")
                   ->expected(0, 1)
                   ->type_name("[SECONDS]");
  AddSecurityOptions(*command, options->security);
  auto* tcp = command->add_flag("--tcp", options->tcp,
                                "Connect over TCP, port 7400 (default without a token)");
  command->add_flag("--udp", options->udp, "Connect over UDP, port 7401 (default with a token)")
      ->excludes(tcp);
  command->callback([options, wait, &action] {
    options->waits = wait->count() > 0;
    TellAddressFromWait(options.get());
    action = [options] { return Drain(*options); };
  });
}

}  // namespace furrow::cli
