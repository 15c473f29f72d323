// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/misbehaving_subscribers.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <poll.h>
#include <sys/socket.h>

namespace furrow::load {
namespace {

constexpr int kSubjectsEach = 64;                    // furrowd's limit of subscriptions per peer
constexpr std::int64_t kSlowIntervalUs = 1'000'000;  // also the interval of the disconnect check
constexpr std::int64_t kChurnIntervalUs = 500'000;

// True if the peer closed the connection, even if unread data is still buffered.
// POLLRDHUP reports the end of the stream without reading what is before it.
bool IsCut(int descriptor) {
  pollfd wanted{descriptor, POLLRDHUP, 0};
  return poll(&wanted, 1, 0) > 0;
}

}  // namespace

Result<MisbehavingSubscribers> MisbehavingSubscribers::Open(SocketOpener open,
                                                            const MisbehaviorOptions& options,
                                                            std::uint32_t first, int subjects) {
  MisbehavingSubscribers all(std::move(open), first, std::min(subjects, kSubjectsEach));
  const std::pair<Kind, int> wanted[] = {{Kind::kSlow, options.slow},
                                         {Kind::kStalled, options.stalled},
                                         {Kind::kChurn, options.churn}};
  for (const auto& [kind, count] : wanted) {
    for (int i = 0; i < count; ++i) {
      Member member{.kind = kind, .due_us = 0, .subscriber = nullptr};
      FURROW_RETURN_IF_ERROR(all.Connect(member));
      all.members_.push_back(std::move(member));
    }
  }
  return all;
}

Status MisbehavingSubscribers::Connect(Member& member) {
  auto socket = open_(0);
  FURROW_RETURN_IF_ERROR(socket);
  if (member.kind != Kind::kChurn) {
    // With the default buffer the system would accept megabytes for a subscriber that does not
    // read, and the server would notice much later.
    const int bytes = 4096;
    setsockopt((*socket)->descriptor(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  }
  member.descriptor = (*socket)->descriptor();
  member.subscriber =
      std::make_unique<client::Subscriber>(*std::move(socket), "furrow load, misbehaving");
  for (int i = 0; i < subjects_; ++i) {
    // Answers are not awaited: a stalled subscriber never reads them.
    (void)member.subscriber->Subscribe(protocol::SubscribeWeights{
        .subject = SubjectName(first_ + static_cast<std::uint32_t>(i)), .wait = true});
  }
  return {};
}

void MisbehavingSubscribers::Tick(std::int64_t now_us) {
  for (Member& member : members_) {
    if (now_us < member.due_us) continue;
    const bool churns = member.kind == Kind::kChurn;
    member.due_us = now_us + (churns ? kChurnIntervalUs : kSlowIntervalUs);
    if (churns) {
      Churn(member);
    } else {
      ReadLittle(member, now_us);
    }
  }
}

// Alternates between half a second connected and half a second disconnected.
void MisbehavingSubscribers::Churn(Member& member) {
  if (member.subscriber) {
    member.subscriber.reset();
  } else if (Connect(member).ok()) {  // a failed connect is tried again at the next tick
    ++returns_;
  }
}

void MisbehavingSubscribers::ReadLittle(Member& member, std::int64_t now_us) {
  // The daemon may disconnect such a subscriber. Connecting again keeps up the load.
  if (member.subscriber && IsCut(member.descriptor)) {
    member.subscriber.reset();
    ++cut_;
  }
  if (!member.subscriber) {
    (void)Connect(member);  // a failed connect is tried again a second later
  } else if (member.kind == Kind::kSlow) {
    (void)member.subscriber->Next(now_us, std::chrono::milliseconds(0));
  }
}

}  // namespace furrow::load
