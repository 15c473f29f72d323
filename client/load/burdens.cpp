// SPDX-License-Identifier: Apache-2.0
#include "client/load/burdens.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <sys/socket.h>

namespace furrow::load {

using client::Event;
using std::chrono::milliseconds;

namespace {

constexpr int kSubjectsEach = 64;  // furrowd's limit of subscriptions for one peer
constexpr std::int64_t kSlowIntervalUs = 1'000'000;
constexpr std::int64_t kChurnIntervalUs = 500'000;

}  // namespace

Result<Burdens> Burdens::Open(OpenSocket open, const BurdenOptions& options, int subjects) {
  Burdens all(std::move(open), std::min(subjects, kSubjectsEach));
  const std::pair<Kind, int> wanted[] = {{Kind::kSlow, options.slow},
                                         {Kind::kStalled, options.stalled},
                                         {Kind::kChurn, options.churn}};
  for (const auto& [kind, count] : wanted) {
    for (int i = 0; i < count; ++i) {
      Burden burden{.kind = kind, .due_us = 0, .subscriber = nullptr};
      if (Status status = all.Begin(burden); !status.ok()) return status;
      all.burdens_.push_back(std::move(burden));
    }
  }
  return all;
}

Status Burdens::Begin(Burden& burden) {
  auto socket = open_(0);
  if (!socket.ok()) return socket.status();
  if (burden.kind != Kind::kChurn) {
    // Else the system would read megabytes for who does not, and the server notice much later.
    const int bytes = 4096;
    setsockopt((*socket)->descriptor(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  }
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
    if (burden.kind == Kind::kStalled || now_us < burden.due_us) continue;
    if (burden.kind == Kind::kChurn) {
      Churn(burden, now_us);
    } else {
      burden.due_us = now_us + kSlowIntervalUs;
      if (burden.subscriber) (void)burden.subscriber->Next(now_us, milliseconds(0));
    }
  }
}

// Half a second with a connection, half a second without.
void Burdens::Churn(Burden& burden, std::int64_t now_us) {
  burden.due_us = now_us + kChurnIntervalUs;
  if (burden.subscriber) {
    burden.subscriber.reset();
  } else if (Begin(burden).ok()) {  // a daemon that refuses now may not later
    ++returns_;
  }
}

}  // namespace furrow::load
