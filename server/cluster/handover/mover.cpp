// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/mover.h"

#include <algorithm>
#include <utility>

#include <asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "server/net/await_tuple.h"
#include "server/net/clock.h"

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
  if (moved) ++progress_.moved;
  progress_.why = why;
}

// No wait outlasts the end by much.
Time Mover::Patience(Time most) const {
  constexpr Time kLeast = std::chrono::milliseconds(50);
  return end_ ? std::clamp(*end_ - ReadClock(), kLeast, most) : most;
}

asio::awaitable<void> Mover::Pause(Time time) {
  asio::steady_timer timer(io_);
  timer.expires_after(time);
  co_await timer.async_wait(kAwaitTuple);
  Repeat(ReadClock());
}

asio::awaitable<void> Mover::Run() {
  running_ = true;
  hub_->TakeNothingNew();
  while (!hub_->SubjectNames().empty() && (!end_ || ReadClock() < *end_)) {
    const bool any = co_await MoveAll();
    if (any) continue;
    if (end_) break;
    co_await Pause(kNextRound);
  }
  // The last states are on their way.
  while (!sent_.empty()) co_await Pause(kLook);  // for at most kAnswerPatience
  for (const auto& [name, link] : links_) link->Close();
  links_.clear();
  running_ = false;
}

// True if any subject was moved.
asio::awaitable<bool> Mover::MoveAll() {
  bool any = false;
  for (const std::string& subject : hub_->SubjectNames()) {
    if (end_ && ReadClock() >= *end_) break;
    const Status status = co_await Move(subject);
    any |= status.ok();
    Note(status.ok(), status.ok() ? "" : "'" + subject + "': " + status.what());
    // Rounds are short, and most subjects stay for the same reason.
    if (!status.ok() && logged_ != status.what()) {
      logged_ = status.what();
      spdlog::warn("subject '{}' stays for now: {}", subject, status.what());
    }
  }
  co_return any;
}

asio::awaitable<Status> Mover::Move(std::string subject) {
  const Place place = hub_->SuccessorOf(subject);
  if (place.kind != Place::Kind::kElsewhere) {
    co_return Status(StatusCode::kUnavailable, place.why);
  }
  const auto link = co_await LinkTo(place.node);
  if (!link.ok()) co_return link.status();
  std::vector<std::uint8_t> message;
  const std::uint32_t number = next_number_++;
  if (!hub_->WriteState(subject, number, message)) co_return Status();  // it has left
  if (message.size() > protocol::kMaxUdpMessageBytes) {
    co_return Status(StatusCode::kLimit, "its state is too large");
  }
  Send(*link, number, std::move(message), /*is_last=*/false);
  while (sent_.contains(number) && !sent_.at(number).accepted) co_await Pause(kLook);
  if (!sent_.contains(number)) {
    links_.erase(place.node.name);  // it may have another address by now
    co_return Status(StatusCode::kUnavailable,
                     "the node '" + place.node.name + "' does not answer");
  }
  const Sent answer = std::move(sent_.extract(number).mapped());
  if (!*answer.accepted) {
    co_return Status(StatusCode::kUnavailable,
                     "the node '" + place.node.name + "' refuses it: " + answer.why);
  }
  const std::uint32_t last = next_number_++;
  if (hub_->HandOver(subject, place.node, last, message, ReadClock())) {
    Send(*link, last, std::move(message), /*is_last=*/true);
  }
  co_return Status();
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
