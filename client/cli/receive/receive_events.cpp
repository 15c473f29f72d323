// SPDX-License-Identifier: Apache-2.0
#include "client/cli/receive/receive_events.h"

#include <cstdio>
#include <utility>

#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/interrupt.h"

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
int ReportNoConnection(client::Event::Kind kind) {
  std::fprintf(stderr, "furrow: %s\n",
               kind == client::Event::Kind::kNoConnection
                   ? "the port is closed (is furrowd running there?)"
                   : "no answer (is furrowd running there?)");
  return kNoConnection;
}

int OnGoodbye(protocol::GoodbyeReason reason) {
  std::fprintf(stderr, "furrow: %s\n", GoodbyeText(reason));
  return reason == protocol::GoodbyeReason::kTimedOut ? kNoConnection : kDone;
}

// Prints when the connection is lost and when it is back.
class ConnectionNotes {
 public:
  void Lost() {
    if (!std::exchange(lost_, true)) {
      std::fprintf(stderr, "furrow: the connection was lost; trying again until Ctrl-C\n");
    }
  }
  // Returns true if the connection had been lost.
  bool Connected() {
    if (!std::exchange(lost_, false)) return false;
    std::fprintf(stderr, "furrow: connected again\n");
    return true;
  }

 private:
  bool lost_ = false;
};

}  // namespace

int ReceiveEvents(client::Subscriber& subscriber,
                  const std::function<bool(const client::Event&)>& on_event,
                  const StopConditions& stop) {
  constexpr std::int64_t kFirstAnswerTimeoutUs = 5'000'000;
  using Kind = client::Event::Kind;
  CatchInterrupts();
  const bool reconnects = subscriber.reconnects();
  const std::int64_t start = SteadyMicroseconds();
  ConnectionNotes notes;
  bool heard = false;
  int goodbyes = 0;
  int exit_code = kDone;
  std::int64_t ends_at = 0;  // 0: not interrupted
  while (!stop.keep_going || stop.keep_going()) {
    const std::int64_t now = SteadyMicroseconds();
    // Goes on for a moment, so that what is under way still arrives.
    if (Interrupted() && ends_at == 0) ends_at = now + stop.drain_us;
    if (ends_at != 0 && now >= ends_at) break;
    const client::Event event = subscriber.Next(now, std::chrono::milliseconds(100));
    switch (event.kind) {
      case Kind::kTimeout:
      case Kind::kNoConnection:
        if (ends_at != 0) return exit_code;
        // Once the daemon has answered, silence is normal. Before that, a daemon that is starting
        // gets some seconds.
        if (heard && event.kind == Kind::kNoConnection && reconnects) notes.Lost();
        if (heard ? event.kind == Kind::kTimeout || reconnects
                  : now - start < kFirstAnswerTimeoutUs) {
          continue;
        }
        return ReportNoConnection(event.kind);
      case Kind::kConnected:
        heard = true;
        if (notes.Connected() && stop.on_return) stop.on_return();
        continue;
      case Kind::kClosed:
        std::fprintf(stderr, "furrow: the daemon closed the connection\n");
        return kNoConnection;
      case Kind::kError:
        std::fprintf(stderr, "furrow: the daemon reports an error: %s\n",
                     subscriber.error().message.c_str());
        exit_code = kFailed;
        if (stop.survives_errors && stop.survives_errors()) continue;
        return exit_code;
      case Kind::kGoodbye: {
        const protocol::GoodbyeReason reason = subscriber.goodbye().reason;
        // Each subscription gets its own goodbye; the last one ends the command.
        if (reason == protocol::GoodbyeReason::kSubjectGone && ++goodbyes != stop.goodbyes)
          continue;
        // A daemon that shuts down may be restarted, and one that lost this client answers again.
        if (reconnects && (reason == protocol::GoodbyeReason::kDraining ||
                           reason == protocol::GoodbyeReason::kTimedOut)) {
          notes.Lost();
          continue;
        }
        return OnGoodbye(reason);
      }
      default:
        heard = true;
        if (!on_event(event)) return exit_code;
    }
  }
  return exit_code;
}

}  // namespace furrow::cli
