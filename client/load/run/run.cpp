// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/status.h"
#include "client/load/run/senders.h"
#include "client/load/run/watchers.h"
#include "client/net/clock.h"
#include "client/net/descriptor.h"
#include "client/net/open_socket.h"
#include "client/net/poller.h"
#include "protocol/framing/envelope.h"
#include "protocol/framing/fragment.h"

namespace furrow::load {
namespace {

using client::IoStatus;
using client::TransportKind;

// The server limits the messages per second of one peer (furrowd: 20,000); stay well below.
constexpr double kMessagesPerSocket = 8000.0;
constexpr int kPosesAtOnce = 32;  // sends before the next read, even if poses are overdue
constexpr int kReadsAtOnce = 16;  // reads before the next check for the end of the run
constexpr std::int64_t kLongestWaitNs = 20'000'000;
constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::uint64_t kWatcherToken = std::uint64_t{1} << 32;

// Opens sockets to the target; with kBoth every second one uses TCP.
SocketOpener Opener(const Target& target, Path path) {
  return [target, path](int i) -> Result<std::unique_ptr<net::Socket>> {
    const bool tcp = path == Path::kTcp || (path == Path::kBoth && i % 2 == 1);
    return net::OpenSocket(tcp ? TransportKind::kTcp : TransportKind::kUdp, target.host,
                           tcp ? target.tcp : target.udp, target.security, target.certificate_host);
  };
}

// Resolves the name for the first socket only, because later sockets open during the run.
SocketOpener ResolvedOpener(Target target, Path path) {
  return [target = std::move(target), path](int i) mutable -> Result<std::unique_ptr<net::Socket>> {
    auto socket = Opener(target, path)(i);
    FURROW_RETURN_IF_ERROR(socket);
    if (target.certificate_host.empty()) target.certificate_host = target.host;
    if (const std::string host = net::PeerHost((*socket)->descriptor()); !host.empty())
      target.host = host;
    return socket;
  };
}

// As many sockets as the daemon's message rate per peer requires, at most one per subject.
int NumSockets(const Workload& workload, const Plan& plan, Path path) {
  const double datagrams =
      static_cast<double>(protocol::NumDatagrams(workload.messages.front().size()));
  const double wanted = std::ceil(plan.poses_per_second() * datagrams / kMessagesPerSocket);
  const int least = path == Path::kBoth ? 2 : 1;
  return std::clamp(static_cast<int>(wanted), std::min(least, plan.num_subjects()),
                    plan.num_subjects());
}

// Adds the address and a hint to a kUnavailable status that has neither.
Status Located(const Status& status, const Target& target, Path path) {
  const bool is_whole = !status.where().empty() || !status.todo().empty();
  if (status.code() != StatusCode::kUnavailable || is_whole) return status;
  const auto names = [&status](const std::string& address) {
    return status.what().find(address) != std::string::npos;
  };
  const std::string tcp = client::AddressText(target.host, target.tcp);
  if (path != Path::kTcp && names(tcp + " over TCP")) {
    return {status.code(), status.what(), "", "name furrowd's TCP port with --other-port"};
  }
  const std::string udp = client::AddressText(target.host, target.udp);
  const std::string& address = path == Path::kTcp ? tcp : udp;
  return {status.code(), status.what(), names(address) ? "" : address, "is furrowd running there?"};
}

// The state of one run.
class Runner {
 public:
  Runner(const Workload& workload, const Target& target, const RunOptions& options,
         const RunHooks& hooks)
      : workload_(workload),
        target_(target),
        options_(options),
        hooks_(hooks),
        plan_(workload.times, options.plan),
        slots_(plan_) {}

  // Everything slow happens here, before the first pose is due: solving, names, connections,
  // offers.
  Status Prepare();
  RunResult Go();

 private:
  Status OpenSockets();
  void SendDue(std::int64_t now_ns);
  void Listen(net::Socket& socket, std::uint64_t token);
  bool ReadReady(net::Poller* poller, std::int64_t timeout_ns);
  IoStatus ReadWatcher(std::size_t socket);
  void ReadEchoes(std::size_t socket);
  void EverySecond(std::int64_t now_ns);
  [[nodiscard]] bool Over(std::int64_t now_ns);
  [[nodiscard]] std::int64_t NextDueNs() const { return start_ns_ + slots_.next().due_us * 1000; }
  // Nanoseconds until the next pose is due, limited so that the end of the run is noticed.
  [[nodiscard]] std::int64_t TimeLeft() const {
    if (slots_.done()) return kLongestWaitNs;
    return std::min(NextDueNs() - net::SteadyNanoseconds(), kLongestWaitNs);
  }
  void End(std::string why) {
    result_.complaint = std::move(why);
    result_.ended_early = true;
  }
  void ResolveMismatches();
  RunResult Report();

  const Workload& workload_;
  const Target& target_;
  const RunOptions& options_;
  const RunHooks& hooks_;
  Plan plan_;
  PlanSlots slots_;
  std::optional<ExpectedWeights> expected_;
  std::optional<Checker> checker_;
  std::optional<Senders> senders_;
  std::optional<Watchers> watchers_;
  std::optional<MisbehavingSubscribers> misbehaving_;
  // The kernel stamps datagrams, so they can wait until due poses have been sent. TCP data counts
  // from the read, so it must end the wait.
  net::Poller datagrams_;
  net::Poller streams_;
  RunResult result_;
  std::int64_t start_ns_ = 0;
  std::int64_t capture_start_us_ = 0;
  std::int64_t last_arrival_ns_ = 0;
  std::int64_t next_second_ns_ = 0;
  std::int64_t last_due_ns_ = 0;  // due time of the last pose sent
  std::int64_t refused_ns_ = 0;   // time of the last refused datagram; 0: none
};

Status Runner::Prepare() {
  // An echo returns poses, not weights, so only its latency is measured.
  if (options_.check_weights && workload_.binding && !target_.echo) {
    expected_.emplace(workload_, plan_, [this](double share) {
      hooks_.solving(share);
      return hooks_.keep_going();
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

void Runner::Listen(net::Socket& socket, std::uint64_t token) {
  net::Poller& poller = socket.kind() == TransportKind::kUdp ? datagrams_ : streams_;
  poller.Add(socket.descriptor(), token);
}

Status Runner::OpenSockets() {
  const SocketOpener open = Opener(target_, options_.path);
  auto senders = Senders::Open(open, NumSockets(workload_, plan_, options_.path), workload_);
  FURROW_RETURN_IF_ERROR(senders);
  senders_.emplace(*std::move(senders));
  if (options_.redundant) senders_->RepeatPrevious(plan_);
  if (target_.echo) return {};
  // Subjects before watchers: a subscription to an unknown subject is refused.
  FURROW_RETURN_IF_ERROR(senders_->Offer(options_.first, plan_.num_subjects(), hooks_.keep_going));
  const auto names =
      workload_.binding ? workload_.binding->weight_names() : std::span<const std::string>();
  auto watchers =
      Watchers::Open(open, options_.watchers, options_.first, plan_.num_subjects(), names);
  FURROW_RETURN_IF_ERROR(watchers);
  watchers_.emplace(*std::move(watchers));
  FURROW_RETURN_IF_ERROR(watchers_->Subscribe(hooks_.keep_going));
  auto misbehaving =
      MisbehavingSubscribers::Open(ResolvedOpener(target_, Path::kTcp), options_.misbehavior,
                                   options_.first, plan_.num_subjects());
  FURROW_RETURN_IF_ERROR(misbehaving);
  misbehaving_.emplace(*std::move(misbehaving));
  return {};
}

RunResult Runner::Go() {
  const auto before = target_.pid ? ReadUsage(*target_.pid) : std::nullopt;
  // Slightly in the future, so that the first poses are not late before the loop begins.
  start_ns_ = net::SteadyNanoseconds() + kLongestWaitNs;
  last_arrival_ns_ = start_ns_;
  next_second_ns_ = start_ns_ + kSecondNs;
  capture_start_us_ = start_ns_ / 1000;
  for (std::int64_t now = net::SteadyNanoseconds(); !Over(now); now = net::SteadyNanoseconds()) {
    // Sending comes first and reading fills the time that is left. Datagrams lose nothing by
    // waiting, because the kernel has stamped their arrival.
    SendDue(now);
    for (int i = 0; i < kReadsAtOnce && ReadReady(&datagrams_, 0) && TimeLeft() > 0; ++i) {
    }
    // Sleeps until TCP data arrives or the next pose is due.
    (void)ReadReady(&streams_, TimeLeft());
    EverySecond(now);
  }
  // An interrupt may arrive before the first pose is due, so clamp.
  result_.seconds =
      static_cast<double>(std::clamp<std::int64_t>(net::SteadyNanoseconds() - start_ns_, 0,
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
  if (!hooks_.keep_going()) {
    result_.interrupted = true;
    return true;
  }
  // All poses are sent. The run ends when all weights are there, or none has come for
  // drain_seconds.
  if (!slots_.done()) return false;
  const auto patience = std::llround(options_.drain_seconds * 1e9);
  return checker_->complete() || now_ns - std::max(last_arrival_ns_, last_due_ns_) > patience;
}

void Runner::SendDue(std::int64_t now_ns) {
  for (int i = 0; i < kPosesAtOnce && !slots_.done() && NextDueNs() <= now_ns; ++i) {
    const Plan::Slot slot = slots_.next();
    // Due times are fixed in advance. If this thread is late, it catches up and never skips or
    // shifts a pose, or the load would follow the speed of the server (coordinated omission).
    last_due_ns_ = NextDueNs();
    const int phase = plan_.phase_of(slot.subject);
    const IoStatus status = senders_->Send(slot.subject, slot.pose, plan_.Frame(phase, slot.pose),
                                           capture_start_us_ + plan_.CaptureUs(phase, slot.pose) +
                                               plan_.ClockOffsetUs(slot.subject, slot.pose));
    // Read again: a send may take long, and poses may have become due in the meantime.
    now_ns = net::SteadyNanoseconds();
    result_.send_delay_ns.Record(now_ns - last_due_ns_);
    // A full send buffer means a pose that was offered and not sent. It does not count as lost.
    checker_->OnDue(slot.subject, slot.pose, status == IoStatus::kOk);
    if (status == IoStatus::kNoConnection) refused_ns_ = now_ns;
    if (status == IoStatus::kClosed) return End("the daemon closed the connection");
    slots_.Pop();
  }
}

// Returns true if more events may be waiting.
bool Runner::ReadReady(net::Poller* poller, std::int64_t timeout_ns) {
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
    if (status == IoStatus::kNoConnection) refused_ns_ = net::SteadyNanoseconds();
    if (status == IoStatus::kClosed) End("the daemon closed the connection");
  }
  return events.size() == net::Poller::kMaxEvents;
}

IoStatus Runner::ReadWatcher(std::size_t socket) {
  return watchers_->Read(socket, [this](const Watchers::Arrival& arrival) {
    // The arrival at this machine, not the moment at which this loop got round to reading.
    const std::int64_t arrived_us = (arrival.arrived_ns - start_ns_) / 1000;
    if (arrival.aged) {
      return checker_->OnAged(arrival.watcher, arrival.subject, arrival.sequence, arrived_us);
    }
    last_arrival_ns_ = arrival.arrived_ns;
    checker_->OnWeights(arrival.watcher, arrival.subject, arrival.sequence, arrival.values,
                        arrival.readable, arrived_us);
  });
}

void Runner::ReadEchoes(std::size_t socket) {
  constexpr int kMaxEchoes = 256;  // a flood on one socket must not block the others
  net::Socket& from = senders_->socket(socket);
  std::span<const std::uint8_t> message;
  for (int i = 0; i < kMaxEchoes || from.holds(); ++i) {
    if (from.Receive(message, std::chrono::milliseconds(0)) != IoStatus::kOk) return;
    protocol::Envelope envelope;
    if (protocol::ReadEnvelope(message, envelope) != protocol::EnvelopeStatus::kOk) continue;
    last_arrival_ns_ = from.arrived_ns();
    checker_->OnWeights(0, senders_->subject(socket, envelope.header.stream),
                        envelope.header.sequence, {}, false, (last_arrival_ns_ - start_ns_) / 1000);
  }
}

void Runner::EverySecond(std::int64_t now_ns) {
  if (misbehaving_) misbehaving_->Tick(now_ns / 1000);
  if (now_ns < next_second_ns_) return;
  next_second_ns_ += kSecondNs;
  // Reading renews the leases, which expire otherwise.
  for (std::size_t i = 0; watchers_ && i < watchers_->num_sockets(); ++i) (void)ReadWatcher(i);
  hooks_.second(static_cast<double>(now_ns - start_ns_) * 1e-9, checker_->tally(),
                checker_->latency_ns());
}

// Limits the time after an interrupt to two seconds.
void Runner::ResolveMismatches() {
  const std::int64_t deadline_ns = net::SteadyNanoseconds() + 2 * kSecondNs;
  const bool finished = checker_->ResolveMismatches(workload_, [&](double share) {
    hooks_.resolving(share);
    return hooks_.keep_going() || net::SteadyNanoseconds() < deadline_ns;
  });
  result_.interrupted = result_.interrupted || !finished;
}

RunResult Runner::Report() {
  if (expected_) ResolveMismatches();
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
  if (misbehaving_) {
    result_.churn_returns = misbehaving_->returns();
    result_.subscribers_cut = misbehaving_->cut();
  }
  // UDP has no end of connection. A server that refuses datagrams and sends nothing more is gone.
  if (refused_ns_ > last_arrival_ns_) {
    End("the daemon's port is closed");
  } else if (refused_ns_ > 0 && result_.complaint.empty()) {
    result_.complaint = "the daemon's port was closed for part of the run";
  }
  if (!target_.echo) senders_->Close();
  return std::move(result_);
}

}  // namespace

std::optional<double> RunResult::cpu_us_per_pose() const {
  if (!cpu_seconds || tally.sent == 0) return std::nullopt;
  return *cpu_seconds * 1e6 / static_cast<double>(tally.sent);
}

Result<RunResult> Run(const Workload& workload, const Target& target, const RunOptions& options,
                      const RunHooks& hooks) {
  Runner runner(workload, target, options, hooks);
  if (Status status = runner.Prepare(); !status.ok()) return Located(status, target, options.path);
  return runner.Go();
}

}  // namespace furrow::load
