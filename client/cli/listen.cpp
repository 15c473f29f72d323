// SPDX-License-Identifier: Apache-2.0
#include "client/cli/listen.h"

#include <cstdio>

#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupt.h"

namespace furrow::cli {
namespace {

const char* GoodbyeText(protocol::GoodbyeReason reason) {
  switch (reason) {
    case protocol::GoodbyeReason::kSubjectGone: return "the subject has left";
    case protocol::GoodbyeReason::kDraining: return "the daemon shuts down";
    case protocol::GoodbyeReason::kTimedOut:
      return "the daemon heard nothing from here for too long";
    case protocol::GoodbyeReason::kDone: break;
  }
  return "the subscription ended";
}

int OnGoodbye(protocol::GoodbyeReason reason) {
  std::fprintf(stderr, "furrow: %s\n", GoodbyeText(reason));
  return reason == protocol::GoodbyeReason::kTimedOut ? kNoConnection : kDone;
}

}  // namespace

int Listen(client::Subscriber& subscriber,
           const std::function<bool(const client::Event&)>& on_event, const ListenEnd& end) {
  constexpr std::int64_t kSilence = 5'000'000;
  using Kind = client::Event::Kind;
  CatchInterrupts();
  const std::int64_t start = SteadyMicroseconds();
  bool heard = false;
  int goodbyes = 0;
  while (!Interrupted() && (!end.goes_on || end.goes_on())) {
    const std::int64_t now = SteadyMicroseconds();
    const client::Event event = subscriber.Next(now, std::chrono::milliseconds(100));
    switch (event.kind) {
      case Kind::kTimeout:
        if (heard || now - start < kSilence) continue;
        std::fprintf(stderr, "furrow: nobody answers (is furrowd running there?)\n");
        return kNoConnection;
      case Kind::kNoConnection:
        if (!heard && now - start < kSilence) continue;
        std::fprintf(stderr, "furrow: nobody listens at that port\n");
        return kNoConnection;
      case Kind::kClosed:
        std::fprintf(stderr, "furrow: the daemon closed the connection\n");
        return kNoConnection;
      case Kind::kError:
        std::fprintf(stderr, "furrow: the daemon says: %s\n", subscriber.error().message.c_str());
        return kFailed;
      case Kind::kGoodbye: {
        const protocol::GoodbyeReason reason = subscriber.goodbye().reason;
        if (reason == protocol::GoodbyeReason::kSubjectGone && ++goodbyes != end.goodbyes) continue;
        return OnGoodbye(reason);
      }
      case Kind::kReply:
      case Kind::kWeights:
      case Kind::kPicture:
      case Kind::kSkeleton:
      case Kind::kPose:
      case Kind::kDropped:
        heard = true;
        if (!on_event(event)) return kDone;
        break;
    }
  }
  return kDone;
}

}  // namespace furrow::cli
