// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/watchers.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/status.h"
#include "client/net/clock.h"
#include "protocol/messages/hash.h"

namespace furrow::load {

using client::Event;
using client::IoStatus;
using std::chrono::milliseconds;

namespace {

constexpr int kSubscriptionsPerPeer = 64;  // furrowd's limit
constexpr std::int64_t kReplyTimeoutNs = 10'000'000'000;

std::int64_t NowUs() { return net::SteadyNanoseconds() / 1000; }

}  // namespace

Result<Watchers> Watchers::Open(const SocketOpener& open, int watchers, std::uint32_t first_number,
                                int subjects, std::span<const std::string> names) {
  Watchers all;
  all.first_ = first_number;
  all.names_hash_ = protocol::NamesHash(names);
  for (int watcher = 0; watcher < watchers; ++watcher) {
    for (int first = 0; first < subjects; first += kSubscriptionsPerPeer) {
      auto socket = open(static_cast<int>(all.links_.size()));
      FURROW_RETURN_IF_ERROR(socket);
      Link& link = all.links_.emplace_back();
      link.watcher = watcher;
      for (int i = first; i < std::min(first + kSubscriptionsPerPeer, subjects); ++i)
        link.subjects.push_back(static_cast<std::uint32_t>(i));
      link.socket = socket->get();
      link.subscriber = std::make_unique<client::Subscriber>(*std::move(socket), "furrow load");
    }
  }
  return all;
}

Status Watchers::Subscribe(const std::function<bool()>& keep_going) {
  for (Link& link : links_) {
    for (const std::uint32_t subject : link.subjects) {
      const std::uint32_t request = link.subscriber->Subscribe(
          protocol::SubscribeWeights{.subject = SubjectName(first_ + subject)});
      link.asked.emplace(request, subject);
    }
    FURROW_RETURN_IF_ERROR(WaitForReplies(link, keep_going));
  }
  return {};
}

Status Watchers::WaitForReplies(Link& link, const std::function<bool()>& keep_going) {
  const std::int64_t deadline = net::SteadyNanoseconds() + kReplyTimeoutNs;
  while (link.subscriptions.size() < link.subjects.size() && keep_going()) {
    if (net::SteadyNanoseconds() > deadline)
      return {StatusCode::kUnavailable, "no answer to the subscriptions"};
    const Event event = link.subscriber->Next(NowUs(), milliseconds(20));
    switch (event.kind) {
      case Event::Kind::kReply: OnReply(link, event.header); break;
      case Event::Kind::kError:
        return {StatusCode::kInvalidArgument,
                "the daemon rejects a subscription: " + link.subscriber->error().message};
      case Event::Kind::kClosed:
        return {StatusCode::kUnavailable, "the daemon closed the connection"};
      case Event::Kind::kNoConnection:
        return {StatusCode::kUnavailable, "no answer to the subscriptions: the port is closed"};
      default: break;
    }
  }
  return {};
}

void Watchers::OnReply(Link& link, const protocol::Header& header) {
  const auto asked = link.asked.find(header.sequence);
  // Requests are matched by number: answers may come in any order, and twice over UDP.
  if (asked == link.asked.end()) return;
  link.subscriptions[header.stream] = asked->second;
  const protocol::SubscribeReply& reply = link.subscriber->reply();
  // Weights of another rig cannot be compared with the solver's.
  names_match_ = names_match_ && reply.names_hash == names_hash_;
  const std::string name = SubjectName(first_ + asked->second);
  if (reply.subject != name) {
    complaint_ = "subscribed to '" + name + "' and received '" + reply.subject + "'";
  }
}

void Watchers::OnWeights(Link& link, const protocol::Header& header,
                         const std::function<void(const Arrival&)>& use) {
  const auto subject = link.subscriptions.find(header.stream);
  const protocol::WeightFrame& frame = link.subscriber->weights();
  if (subject == link.subscriptions.end()) return;
  use({.watcher = link.watcher,
       .subject = subject->second,
       .sequence = header.sequence,
       .arrived_ns = link.socket->arrived_ns(),
       .values = frame.values,
       .readable = frame.names_hash == names_hash_,
       .aged = frame.age_us > 0});
}

IoStatus Watchers::Read(std::size_t i, const std::function<void(const Arrival&)>& use) {
  constexpr int kMaxMessages = 256;  // a flood on one socket must not block the others
  Link& link = links_[i];
  const std::int64_t now_us = NowUs();
  // What the socket has taken from the kernel must be read to the end: the poller does not see it.
  for (int n = 0; n < kMaxMessages || link.socket->holds(); ++n) {
    const Event event = link.subscriber->Next(now_us, milliseconds(0));
    switch (event.kind) {
      case Event::Kind::kTimeout: return IoStatus::kOk;
      case Event::Kind::kWeights: OnWeights(link, event.header, use); break;
      case Event::Kind::kReply: OnReply(link, event.header); break;
      case Event::Kind::kError: complaint_ = link.subscriber->error().message; break;
      case Event::Kind::kGoodbye: complaint_ = "the daemon ended a subscription"; break;
      case Event::Kind::kClosed: return IoStatus::kClosed;
      case Event::Kind::kNoConnection: return IoStatus::kNoConnection;
      default: break;  // events that were not requested
    }
  }
  return IoStatus::kOk;
}

std::uint64_t Watchers::malformed() const {
  std::uint64_t sum = 0;
  for (const Link& link : links_) sum += link.subscriber->malformed();
  return sum;
}

}  // namespace furrow::load
