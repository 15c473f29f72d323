// SPDX-License-Identifier: Apache-2.0
#include "client/load/burdens.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <poll.h>
#include <sys/socket.h>

#include "base/status.h"

namespace furrow::load {

using client::Event;
using std::chrono::milliseconds;

namespace {

constexpr int kSubjectsEach = 64;  // furrowd's limit of subscriptions for one peer
constexpr std::int64_t kSlowIntervalUs = 1'000'000;  // also of looking who was cut off
constexpr std::int64_t kChurnIntervalUs = 500'000;

// Whether the other end has closed, also behind bytes that were not read.
bool IsCut(int descriptor) {
  pollfd wanted{descriptor, POLLRDHUP, 0};
  return poll(&wanted, 1, 0) > 0;
}

}  // namespace

Result<Burdens> Burdens::Open(OpenSocket open, const BurdenOptions& options, int subjects) {
  Burdens all(std::move(open), std::min(subjects, kSubjectsEach));
  const std::pair<Kind, int> wanted[] = {{Kind::kSlow, options.slow},
                                         {Kind::kStalled, options.stalled},
                                         {Kind::kChurn, options.churn}};
  for (const auto& [kind, count] : wanted) {
    for (int i = 0; i < count; ++i) {
      Burden burden{.kind = kind, .due_us = 0, .subscriber = nullptr};
      FURROW_RETURN_IF_ERROR(all.Begin(burden));
      all.burdens_.push_back(std::move(burden));
    }
  }
  return all;
}

Status Burdens::Begin(Burden& burden) {
  auto socket = open_(0);
  FURROW_RETURN_IF_ERROR(socket);
  if (burden.kind != Kind::kChurn) {
    // Else the system would read megabytes for who does not, and the server notice much later.
    const int bytes = 4096;
    setsockopt((*socket)->descriptor(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  }
  burden.descriptor = (*socket)->descriptor();
  burden.subscriber =
      std::make_unique<client::Subscriber>(*std::move(socket), "furrow load, misbehaving");
  for (int i = 0; i < subjects_; ++i) {
    (void)burden.subscriber->Subscribe(protocol::SubscribeWeights{
        .subject = SubjectName(static_cast<std::uint32_t>(i)), .wait = true});
  }
  return {};
}

void Burdens::Tick(std::int64_t now_us) {
  for (Burden& burden : burdens_) {
    if (now_us < burden.due_us) continue;
    const bool churns = burden.kind == Kind::kChurn;
    burden.due_us = now_us + (churns ? kChurnIntervalUs : kSlowIntervalUs);
    if (churns) {
      Churn(burden);
    } else {
      Weigh(burden, now_us);
    }
  }
}

// Half a second with a connection, half a second without.
void Burdens::Churn(Burden& burden) {
  if (burden.subscriber) {
    burden.subscriber.reset();
  } else if (Begin(burden).ok()) {  // a daemon that refuses now may not later
    ++returns_;
  }
}

void Burdens::Weigh(Burden& burden, std::int64_t now_us) {
  if (burden.subscriber && IsCut(burden.descriptor)) {
    burden.subscriber.reset();
    ++cut_;
  }
  if (!burden.subscriber) {
    (void)Begin(burden);  // once more a second later where that fails
  } else if (burden.kind == Kind::kSlow) {
    (void)burden.subscriber->Next(now_us, milliseconds(0));
  }
}

}  // namespace furrow::load
