// SPDX-License-Identifier: Apache-2.0
#include "client/cli/receive/receive_events.h"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "client/cli/common/connection_notes.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/common/refusal_note.h"

namespace furrow::cli {
namespace {

const char* GoodbyeText(protocol::GoodbyeReason reason) {
  switch (reason) {
    case protocol::GoodbyeReason::kSubjectGone: return "the subject left";
    case protocol::GoodbyeReason::kDraining: return "the daemon is shutting down";
    case protocol::GoodbyeReason::kTimedOut: return "the daemon timed out waiting for this client";
    case protocol::GoodbyeReason::kDone: break;
  }
  return "the subscription ended";
}

// The daemon never answered, or its port closed.
int ReportNoConnection(client::Event::Kind kind, const std::string& why) {
  if (!why.empty()) {
    std::fprintf(stderr, "furrow: no connection: %s\n", why.c_str());
    return kNoConnection;
  }
  std::fprintf(
      stderr, "furrow: %s\n",
      kind == client::Event::Kind::kNoConnection
          ? "the port is closed, or another program listens at it (is furrowd running there?)"
          : "no answer (is furrowd running there?)");
  return kNoConnection;
}

// True for the goodbyes of a daemon that ends the connection, and not the subscription alone.
bool IsLoss(protocol::GoodbyeReason reason) {
  using protocol::GoodbyeReason;
  return reason == GoodbyeReason::kDraining || reason == GoodbyeReason::kTimedOut;
}

int ReportGoodbye(protocol::GoodbyeReason reason) {
  std::fprintf(stderr, "furrow: %s\n", GoodbyeText(reason));
  return IsLoss(reason) ? kNoConnection : kDone;
}

// The loop of ReceiveEvents(), with what it remembers between events.
class Reception {
 public:
  Reception(client::Subscriber& subscriber, const StopConditions& stop)
      : subscriber_(subscriber), stop_(stop), reconnects_(subscriber.reconnects()) {}

  int Run(const std::function<bool(const client::Event&)>& on_event) {
    while (!stop_.keep_going || stop_.keep_going()) {
      const std::int64_t now = SteadyMicroseconds();
      // Goes on for a moment, so that what is under way still arrives.
      if (Interrupted() && ends_at_us_ == 0) ends_at_us_ = now + stop_.drain_us;
      if (ends_at_us_ != 0 && now >= ends_at_us_) break;
      const client::Event event = subscriber_.Next(now, std::chrono::milliseconds(100));
      if (const std::optional<int> ended = Handle(event, now, on_event)) return *ended;
    }
    return exit_code_;
  }

 private:
  using Kind = client::Event::Kind;

  // These return the exit code if the reception has ended.
  std::optional<int> Handle(const client::Event& event, std::int64_t now_us,
                            const std::function<bool(const client::Event&)>& on_event) {
    switch (event.kind) {
      case Kind::kTimeout:
      case Kind::kNoConnection: return OnSilence(event.kind, now_us);
      case Kind::kError: return OnError();
      case Kind::kGoodbye: return OnGoodbye(subscriber_.goodbye().reason);
      case Kind::kClosed:
        std::fprintf(stderr, "furrow: the daemon closed the connection\n");
        return kNoConnection;
      case Kind::kConnected:
        heard_ = true;
        if (notes_.Connected() && stop_.on_return) stop_.on_return();
        return std::nullopt;
      default:
        heard_ = true;
        if (on_event(event)) return std::nullopt;
        return exit_code_;
    }
  }

  std::optional<int> OnSilence(Kind kind, std::int64_t now_us) {
    constexpr std::int64_t kFirstAnswerTimeoutUs = 5'000'000;
    if (ends_at_us_ != 0) return exit_code_;
    if (!heard_) {
      // A daemon that is starting gets some seconds.
      if (now_us - start_us_ < kFirstAnswerTimeoutUs) return std::nullopt;
      return ReportNoConnection(kind, subscriber_.failure());
    }
    // Once the daemon has answered, silence is normal.
    if (kind == Kind::kTimeout) return std::nullopt;
    if (!reconnects_) return ReportNoConnection(kind, subscriber_.failure());
    notes_.Lost();
    refusal_.Show(subscriber_.refusal());
    return std::nullopt;
  }

  std::optional<int> OnError() {
    std::fprintf(stderr, "furrow: the daemon reports an error: %s\n",
                 subscriber_.error().message.c_str());
    exit_code_ = kFailed;
    if (stop_.survives_errors && stop_.survives_errors()) return std::nullopt;
    return exit_code_;
  }

  std::optional<int> OnGoodbye(protocol::GoodbyeReason reason) {
    using protocol::GoodbyeReason;
    // Each subscription gets its own goodbye; the last one ends the command.
    if (reason == GoodbyeReason::kSubjectGone && ++goodbyes_ != stop_.goodbyes) return std::nullopt;
    // A daemon that shuts down may be restarted, and one that lost this client answers again.
    if (IsLoss(reason) && reconnects_) {
      notes_.Lost();
      return std::nullopt;
    }
    return ReportGoodbye(reason);
  }

  client::Subscriber& subscriber_;
  const StopConditions& stop_;
  const bool reconnects_;
  const std::int64_t start_us_ = SteadyMicroseconds();
  ConnectionNotes notes_;
  RefusalNote refusal_;
  bool heard_ = false;
  int goodbyes_ = 0;
  int exit_code_ = kDone;
  std::int64_t ends_at_us_ = 0;  // 0: not interrupted
};

}  // namespace

int ReceiveEvents(client::Subscriber& subscriber,
                  const std::function<bool(const client::Event&)>& on_event,
                  const StopConditions& stop) {
  CatchInterrupts();
  return Reception(subscriber, stop).Run(on_event);
}

}  // namespace furrow::cli
