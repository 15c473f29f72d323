// SPDX-License-Identifier: Apache-2.0
#include "client/load/run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/status.h"
#include "client/load/net/clock.h"
#include "client/load/net/poller.h"
#include "client/load/schedule/senders.h"
#include "client/load/watchers.h"
#include "protocol/framing/envelope.h"
#include "protocol/framing/fragment.h"

namespace furrow::load {
namespace {

using client::IoStatus;
using client::TransportKind;

// A server allows one peer so many messages a second (furrowd: 20,000): stay well below.
constexpr double kMessagesPerSocket = 8000.0;
constexpr int kPosesAtOnce = 32;  // then it is looked for what came, also when behind
constexpr int kLooksAtOnce = 16;  // then whether the run is over, whatever else comes
constexpr std::int64_t kLongestWaitNs = 20'000'000;
constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::uint64_t kWatcherToken = std::uint64_t{1} << 32;

OpenSocket Opener(const Target& target, Path path) {
  return [target, path](int i) -> Result<std::unique_ptr<Socket>> {
    const bool tcp = path == Path::kTcp || (path == Path::kBoth && i % 2 == 1);
    std::string error;
    auto socket = Socket::Open(tcp ? TransportKind::kTcp : TransportKind::kUdp, target.host,
                               tcp ? target.tcp : target.udp, &error);
    if (!socket) return Status(StatusCode::kUnavailable, error);
    return socket;
  };
}

// The name is resolved for the first socket alone: later ones open in the midst of a run.
OpenSocket ResolvedOpener(Target target, Path path) {
  return [target = std::move(target), path](int i) mutable -> Result<std::unique_ptr<Socket>> {
    auto socket = Opener(target, path)(i);
    FURROW_RETURN_IF_ERROR(socket);
    if (const std::string host = PeerHost((*socket)->descriptor()); !host.empty())
      target.host = host;
    return socket;
  };
}

int NumSockets(const Performance& performance, const Plan& plan, Path path) {
  const double datagrams =
      static_cast<double>(protocol::NumDatagrams(performance.messages.front().size()));
  const double wanted = std::ceil(plan.poses_per_second() * datagrams / kMessagesPerSocket);
  const int least = path == Path::kBoth ? 2 : 1;
  return std::clamp(static_cast<int>(wanted), std::min(least, plan.num_subjects()),
                    plan.num_subjects());
}

// Says where nobody answered, and what that may be for.
Status Located(const Status& status, const Target& target, Path path) {
  if (status.code() != StatusCode::kUnavailable || !status.where().empty()) return status;
  const auto names = [&status](const std::string& address) {
    return status.what().find(address) != std::string::npos;
  };
  const std::string tcp = target.host + ":" + std::to_string(target.tcp);
  if (path != Path::kTcp && names(tcp + " over TCP")) {
    return {status.code(), status.what(), "",
            "--other-port says on which port furrowd listens to TCP"};
  }
  const std::string udp = target.host + ":" + std::to_string(target.udp);
  const std::string& address = path == Path::kTcp ? tcp : udp;
  return {status.code(), status.what(), names(address) ? "" : address, "is furrowd running there?"};
}

// One run that is under way.
class Runner {
 public:
  Runner(const Performance& performance, const Target& target, const RunOptions& options,
         const RunHooks& hooks)
      : performance_(performance),
        target_(target),
        options_(options),
        hooks_(hooks),
        plan_(performance.times, options.plan),
        slots_(plan_) {}

  Status Prepare();
  RunResult Go();

 private:
  Status OpenSockets();
  void SendDue(std::int64_t now_ns);
  void Listen(Socket& socket, std::uint64_t token);
  bool ReadReady(Poller* poller, std::int64_t timeout_ns);
  IoStatus ReadWatcher(std::size_t socket);
  void ReadEchoes(std::size_t socket);
  void EverySecond(std::int64_t now_ns);
  [[nodiscard]] bool Over(std::int64_t now_ns);
  [[nodiscard]] std::int64_t NextDueNs() const { return start_ns_ + slots_.next().due_us * 1000; }
  // Until the next pose is due or it is to be looked whether the run is over.
  [[nodiscard]] std::int64_t TimeLeft() const {
    if (slots_.done()) return kLongestWaitNs;
    return std::min(NextDueNs() - SteadyNanoseconds(), kLongestWaitNs);
  }
  void End(std::string why) {
    result_.complaint = std::move(why);
    result_.ended_early = true;
  }
  void Settle();
  RunResult Report();

  const Performance& performance_;
  const Target& target_;
  const RunOptions& options_;
  const RunHooks& hooks_;
  Plan plan_;
  PlanSlots slots_;
  std::optional<Expected> expected_;
  std::optional<Checker> checker_;
  std::optional<Senders> senders_;
  std::optional<Watchers> watchers_;
  std::optional<Burdens> burdens_;
  // Datagrams count as having come when the system says, so they wait until a pose was sent and
  // delay none; what comes over TCP counts when it is read, so it wakes us.
  Poller datagrams_;
  Poller streams_;
  RunResult result_;
  std::int64_t start_ns_ = 0;
  std::int64_t capture_start_us_ = 0;
  std::int64_t last_arrival_ns_ = 0;
  std::int64_t next_second_ns_ = 0;
  std::int64_t last_due_ns_ = 0;  // of those that were sent
  std::int64_t refused_ns_ = 0;   // when the last datagram was; 0: none
};

Status Runner::Prepare() {
  if (options_.check_weights && performance_.binding && !target_.echo) {
    expected_.emplace(performance_, plan_, [this](double share) {
      hooks_.solving(share);
      return hooks_.go_on();
    });
  }
  checker_.emplace(plan_, expected_ ? &*expected_ : nullptr,
                   CheckOptions{.watchers = target_.echo ? 1 : options_.watchers,
                                .tolerance = options_.tolerance,
                                .late_us = options_.late_us,
                                .seconds = options_.plan.seconds});
  FURROW_RETURN_IF_ERROR(OpenSockets());
  for (std::size_t i = 0; i < senders_->num_sockets(); ++i) Listen(senders_->socket(i), i);
  for (std::size_t i = 0; watchers_ && i < watchers_->num_sockets(); ++i)
    Listen(watchers_->socket(i), kWatcherToken + i);
  return {};
}

void Runner::Listen(Socket& socket, std::uint64_t token) {
  Poller& poller = socket.kind() == TransportKind::kUdp ? datagrams_ : streams_;
  poller.Add(socket.descriptor(), token);
}

Status Runner::OpenSockets() {
  const OpenSocket open = Opener(target_, options_.path);
  auto senders = Senders::Open(open, NumSockets(performance_, plan_, options_.path), performance_);
  FURROW_RETURN_IF_ERROR(senders);
  senders_.emplace(*std::move(senders));
  if (target_.echo) return {};
  FURROW_RETURN_IF_ERROR(senders_->Offer(plan_.num_subjects(), hooks_.go_on));
  const auto names =
      performance_.binding ? performance_.binding->weight_names() : std::span<const std::string>();
  auto watchers = Watchers::Open(open, options_.watchers, plan_.num_subjects(), names);
  FURROW_RETURN_IF_ERROR(watchers);
  watchers_.emplace(*std::move(watchers));
  FURROW_RETURN_IF_ERROR(watchers_->Subscribe(hooks_.go_on));
  auto burdens =
      Burdens::Open(ResolvedOpener(target_, Path::kTcp), options_.burdens, plan_.num_subjects());
  FURROW_RETURN_IF_ERROR(burdens);
  burdens_.emplace(*std::move(burdens));
  return {};
}

RunResult Runner::Go() {
  const auto before = target_.pid ? ReadUsage(*target_.pid) : std::nullopt;
  start_ns_ = SteadyNanoseconds() + kLongestWaitNs;
  last_arrival_ns_ = start_ns_;
  next_second_ns_ = start_ns_ + kSecondNs;
  capture_start_us_ = start_ns_ / 1000;
  for (std::int64_t now = SteadyNanoseconds(); !Over(now); now = SteadyNanoseconds()) {
    SendDue(now);
    for (int i = 0; i < kLooksAtOnce && ReadReady(&datagrams_, 0) && TimeLeft() > 0; ++i) {
    }
    (void)ReadReady(&streams_, TimeLeft());
    EverySecond(now);
  }
  // An interrupt may come before the first pose is due.
  result_.seconds =
      static_cast<double>(std::clamp<std::int64_t>(SteadyNanoseconds() - start_ns_, 0,
                                                   std::llround(options_.plan.seconds * 1e9))) *
      1e-9;
  result_.usage = target_.pid ? ReadUsage(*target_.pid) : std::nullopt;
  result_.usage_unknown = target_.loopback && !before;
  if (before && result_.usage)
    result_.cpu_seconds = result_.usage->cpu_seconds - before->cpu_seconds;
  return Report();
}

bool Runner::Over(std::int64_t now_ns) {
  if (result_.ended_early) return true;
  if (!hooks_.go_on()) {
    result_.interrupted = true;
    return true;
  }
  if (!slots_.done()) return false;
  const auto patience = std::llround(options_.drain_seconds * 1e9);
  return checker_->complete() || now_ns - std::max(last_arrival_ns_, last_due_ns_) > patience;
}

void Runner::SendDue(std::int64_t now_ns) {
  for (int i = 0; i < kPosesAtOnce && !slots_.done() && NextDueNs() <= now_ns; ++i) {
    const Plan::Slot slot = slots_.next();
    last_due_ns_ = NextDueNs();
    const int phase = plan_.phase_of(slot.subject);
    const IoStatus status = senders_->Send(slot.subject, slot.pose, plan_.Frame(phase, slot.pose),
                                           capture_start_us_ + plan_.CaptureUs(phase, slot.pose));
    now_ns = SteadyNanoseconds();
    result_.send_delay_ns.Record(now_ns - last_due_ns_);
    checker_->OnSent(slot.subject, slot.pose, status == IoStatus::kOk);
    if (status == IoStatus::kNoConnection) refused_ns_ = now_ns;
    if (status == IoStatus::kClosed) return End("the daemon closed the connection");
    slots_.Pop();
  }
}

// True: there may be more.
bool Runner::ReadReady(Poller* poller, std::int64_t timeout_ns) {
  const auto events = poller->Wait(timeout_ns);
  for (const epoll_event& event : events) {
    const std::uint64_t token = event.data.u64;
    IoStatus status = IoStatus::kOk;
    if (token >= kWatcherToken) {
      status = ReadWatcher(token - kWatcherToken);
    } else if (target_.echo) {
      ReadEchoes(token);
    } else {
      status = senders_->Read(token);
    }
    if (status == IoStatus::kNoConnection) refused_ns_ = SteadyNanoseconds();
    if (status == IoStatus::kClosed) End("the daemon closed the connection");
  }
  return events.size() == Poller::kMost;
}

IoStatus Runner::ReadWatcher(std::size_t socket) {
  return watchers_->Read(socket, [this](const Watchers::Arrival& arrival) {
    last_arrival_ns_ = arrival.arrived_ns;
    checker_->OnWeights(arrival.watcher, arrival.subject, arrival.sequence, arrival.values,
                        arrival.readable, (last_arrival_ns_ - start_ns_) / 1000);
  });
}

void Runner::ReadEchoes(std::size_t socket) {
  constexpr int kAtOnce = 256;  // a flood on one socket must not keep the others waiting
  Socket& from = senders_->socket(socket);
  std::span<const std::uint8_t> message;
  for (int i = 0; i < kAtOnce || from.holds(); ++i) {
    if (from.Receive(message, std::chrono::milliseconds(0)) != IoStatus::kOk) return;
    protocol::Envelope envelope;
    if (protocol::ReadEnvelope(message, envelope) != protocol::EnvelopeStatus::kOk) continue;
    last_arrival_ns_ = from.arrived_ns();
    checker_->OnWeights(0, senders_->subject(socket, envelope.header.stream),
                        envelope.header.sequence, {}, false, (last_arrival_ns_ - start_ns_) / 1000);
  }
}

void Runner::EverySecond(std::int64_t now_ns) {
  if (burdens_) burdens_->Tick(now_ns / 1000);
  if (now_ns < next_second_ns_) return;
  next_second_ns_ += kSecondNs;
  // Leases lapse where nothing is asked for; reading maintains them.
  for (std::size_t i = 0; watchers_ && i < watchers_->num_sockets(); ++i) (void)ReadWatcher(i);
  hooks_.second(static_cast<double>(now_ns - start_ns_) * 1e-9, checker_->tally(),
                checker_->latency_ns());
}

// Whoever asked for the end is not kept waiting for what was disputed.
void Runner::Settle() {
  const std::int64_t patience_ns = SteadyNanoseconds() + 2 * kSecondNs;
  const bool settled = checker_->Settle(performance_, [&](double share) {
    hooks_.settling(share);
    return hooks_.go_on() || SteadyNanoseconds() < patience_ns;
  });
  result_.interrupted = result_.interrupted || !settled;
}

RunResult Runner::Report() {
  if (expected_) Settle();
  result_.tally = checker_->tally();
  result_.latency_ns = checker_->latency_ns();
  result_.windows.assign(checker_->windows().begin(), checker_->windows().end());
  result_.planned_rate = plan_.poses_per_second();
  result_.planned_seconds = options_.plan.seconds;
  for (std::size_t i = 0; i < senders_->num_sockets(); ++i)
    result_.overrun += senders_->socket(i).overrun();
  if (watchers_) {
    for (std::size_t i = 0; i < watchers_->num_sockets(); ++i)
      result_.overrun += watchers_->socket(i).overrun();
    result_.malformed = watchers_->malformed();
    result_.checked_names = expected_ && watchers_->names_match();
    if (result_.complaint.empty()) result_.complaint = watchers_->complaint();
  }
  if (burdens_) {
    result_.churn_returns = burdens_->returns();
    result_.burdens_cut = burdens_->cut();
  }
  // Datagrams know no end: who refuses them and was not heard again is gone.
  if (refused_ns_ > last_arrival_ns_) {
    End("nobody listens at the port any more");
  } else if (refused_ns_ > 0 && result_.complaint.empty()) {
    result_.complaint = "nobody listened at the port for some of the time";
  }
  if (!target_.echo) senders_->Close();
  return std::move(result_);
}

}  // namespace

std::optional<double> RunResult::cpu_us_per_pose() const {
  if (!cpu_seconds || tally.sent == 0) return std::nullopt;
  return *cpu_seconds * 1e6 / static_cast<double>(tally.sent);
}

Result<RunResult> Run(const Performance& performance, const Target& target,
                      const RunOptions& options, const RunHooks& hooks) {
  Runner runner(performance, target, options, hooks);
  if (Status status = runner.Prepare(); !status.ok()) return Located(status, target, options.path);
  return runner.Go();
}

}  // namespace furrow::load
