// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/mover.h"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/net/clock.h"
#include "server/net/pause.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;

constexpr Time kLook = std::chrono::milliseconds(1);
// An unanswered message is sent again after this time.
constexpr Time kRepeat = std::chrono::milliseconds(20);
constexpr Time kAnswerPatience = std::chrono::milliseconds(1000);
constexpr Time kConnectPatience = std::chrono::milliseconds(1500);
// The pause before subjects are tried again that could not be moved.
constexpr Time kNextRound = std::chrono::milliseconds(200);
constexpr std::uint64_t kTokenSeconds = 600;

}  // namespace

Mover::~Mover() {
  for (const auto& [name, link] : links_) link->Close();
}

Mover::Progress Mover::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void Mover::Note(bool moved, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (moved) {
    ++progress_.moved;  // others may still stay
  } else {
    progress_.why = why;
  }
}

// No wait outlasts the end by much.
Time Mover::Patience(Time most) const {
  constexpr Time kLeast = std::chrono::milliseconds(50);
  return end_ ? std::clamp(*end_ - ReadClock(), kLeast, most) : most;
}

asio::awaitable<void> Mover::Wait(Time time) {
  co_await Pause(time);
  Repeat(ReadClock());
}

asio::awaitable<void> Mover::Run() {
  running_ = true;
  hub_->TakeNothingNew();
  while (!hub_->SubjectNames().empty() && (!end_ || ReadClock() < *end_)) {
    const bool any = co_await MoveAll();
    if (any) continue;
    if (end_) break;
    co_await Wait(kNextRound);
  }
  // The last states are on their way.
  while (!sent_.empty()) co_await Wait(kLook);  // for at most kAnswerPatience
  for (const auto& [name, link] : links_) link->Close();
  links_.clear();
  running_ = false;
}

// True if any subject was moved.
asio::awaitable<bool> Mover::MoveAll() {
  bool any = false;
  silent_.clear();
  for (const std::string& subject : hub_->SubjectNames()) {
    if (end_ && ReadClock() >= *end_) break;
    const Status status = co_await Move(subject);
    const bool has_left = status.code() == StatusCode::kNotFound;
    any |= status.ok() || has_left;
    if (has_left) continue;
    Note(status.ok(), status.ok() ? "" : "'" + subject + "': " + status.what());
    // Rounds are short, and most subjects stay for the same reason.
    if (!status.ok() && logged_ != status.what()) {
      logged_ = status.what();
      spdlog::warn("subject '{}' stays for now: {}", subject, status.what());
    }
  }
  co_return any;
}

// To the node with the most room; if that one does not take it, to the next one.
asio::awaitable<Status> Mover::Move(std::string subject) {
  std::set<std::string> without = silent_;
  Status failure;
  while (!end_ || ReadClock() < *end_) {
    const Place place = hub_->SuccessorOf(subject, ReadClock(), without);
    // A lease may name a node that has refused.
    if (place.kind != Place::Kind::kElsewhere || without.contains(place.node.name)) {
      if (!failure.ok()) break;
      co_return Status(StatusCode::kUnavailable,
                       place.why.empty() ? "no other node answers" : place.why);
    }
    Status status = co_await MoveTo(place.node, subject);
    if (status.code() != StatusCode::kUnavailable) co_return status;
    failure = std::move(status);
    without.insert(place.node.name);
  }
  co_return failure.ok() ? Status(StatusCode::kUnavailable, "the time is over") : failure;
}

// Errors: kUnavailable, another node may take it; kNotFound, it has left; others: it stays.
asio::awaitable<Status> Mover::MoveTo(NodeAddress node, std::string subject) {
  const auto link = co_await LinkTo(node);
  if (!link.ok()) {
    silent_.insert(node.name);
    co_return link.status();
  }
  std::vector<std::uint8_t> message;
  const std::uint32_t number = next_number_++;
  if (!hub_->WriteState(subject, number, message)) {
    co_return Status(StatusCode::kNotFound, "it has left");
  }
  if (message.size() > protocol::kMaxUdpMessageBytes) {
    co_return Status(StatusCode::kLimit,
                     "its state has " + std::to_string(message.size()) + " bytes, more than the " +
                         std::to_string(protocol::kMaxUdpMessageBytes) + " that fit");
  }
  Send(*link, number, std::move(message), /*is_last=*/false);
  while (sent_.contains(number) && !sent_.at(number).accepted) co_await Wait(kLook);
  if (!sent_.contains(number)) {
    Unlink(node.name);  // it may have another address by now
    silent_.insert(node.name);
    co_return Status(StatusCode::kUnavailable, "the node '" + node.name + "' does not answer");
  }
  const Sent answer = std::move(sent_.extract(number).mapped());
  if (!*answer.accepted) {
    if ((*link)->failed()) Unlink(node.name);
    co_return Status(StatusCode::kUnavailable,
                     "the node '" + node.name + "' refuses it: " + answer.why);
  }
  const std::uint32_t last = next_number_++;
  Status status = hub_->HandOver(subject, node, last, message, ReadClock());
  if (status.ok()) Send(*link, last, std::move(message), /*is_last=*/true);
  co_return status;
}

void Mover::Unlink(const std::string& node) {
  const auto known = links_.find(node);
  if (known == links_.end()) return;
  known->second->Close();
  links_.erase(known);
}

asio::awaitable<Result<std::shared_ptr<NodeLink>>> Mover::LinkTo(NodeAddress node) {
  if (const auto known = links_.find(node.name); known != links_.end()) co_return known->second;
  NodeLink::Options options{
      .node = node,
      .session = random_(),
      .token = {},
      .on_answer = [this](std::uint32_t number, bool accepted, const std::string& why) {
        OnAnswer(number, accepted, why);
      }};
  if (gate_->required()) {
    const std::uint64_t now = gate_->unix_now();
    const auto ring = gate_->keys();
    const secure::TokenKey* const key = ring->Newest(now);
    if (key == nullptr) co_return Status(StatusCode::kUnavailable, "no key is valid");
    const secure::Grant grant{.client_id = random_(),
                              .roles = secure::Role::kOperate,
                              .packets_per_second = 0,
                              .subjects = "*",
                              .audience = node.name};
    auto token = secure::MakeToken(key->id, key->key, std::min(key->expires, now + kTokenSeconds),
                                   grant, secure::SystemRandom());
    if (!token.ok()) co_return token.status();
    options.token = *std::move(token);
  }
  auto link = std::make_shared<NodeLink>(io_, std::move(options));
  const Status status = co_await link->Connect(Patience(kConnectPatience));
  if (!status.ok()) {
    link->Close();
    co_return status;
  }
  links_[node.name] = link;
  co_return link;
}

void Mover::Send(const std::shared_ptr<NodeLink>& link, std::uint32_t number,
                 std::vector<std::uint8_t> message, bool is_last) {
  const Time now = ReadClock();
  link->Send(message);
  sent_.insert_or_assign(number, Sent{.link = link,
                                      .message = std::move(message),
                                      .sent = now,
                                      .give_up = now + Patience(kAnswerPatience),
                                      .accepted = {},
                                      .why = {},
                                      .is_last = is_last});
}

void Mover::OnAnswer(std::uint32_t number, bool accepted, const std::string& why) {
  const auto found = sent_.find(number);
  if (found == sent_.end()) return;
  if (found->second.is_last) {
    sent_.erase(found);
    return;
  }
  found->second.accepted = accepted;
  found->second.why = why;
}

void Mover::Repeat(Time now) {
  std::erase_if(sent_, [now](const auto& each) { return now >= each.second.give_up; });
  for (auto& [number, sent] : sent_) {
    if (sent.accepted || now - sent.sent < kRepeat) continue;
    sent.sent = now;
    sent.link->Send(sent.message);
  }
}

}  // namespace furrow::server
