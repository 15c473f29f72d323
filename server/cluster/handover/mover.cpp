// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/mover.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/pause.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;

constexpr Time kLook = std::chrono::milliseconds(1);
constexpr std::uint64_t kTokenSeconds = 600;

}  // namespace

Mover::~Mover() {
  for (const auto& [name, link] : links_) link->Close();
}

Mover::Progress Mover::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void Mover::Note() {
  const Handovers::Progress& progress = handovers_.progress();
  // Rounds are short, and most subjects stay for the same reason.
  if (noted_.why != progress.why) {
    spdlog::warn("subject '{}' stays for now: {}", progress.stays, progress.why);
  }
  const bool is_news = noted_.why != progress.why || noted_.stays != progress.stays;
  const std::lock_guard lock(mutex_);
  progress_.moved = progress.moved;
  if (!is_news) return;
  noted_ = progress;
  progress_.why = "'" + progress.stays + "': " + progress.why;
}

asio::awaitable<void> Mover::Run() {
  handovers_.Begin();
  while (true) {
    handovers_.Tick(ReadClock());
    Note();
    if (!handovers_.running()) co_return;
    co_await Pause(kLook);
  }
}

void Mover::Open(const NodeAddress& node, Time patience) {
  StartCriticalTask(io_, Connect(node, patience));
}

// This node is a client with a token that it has made itself, because all nodes have the same keys.
Result<std::optional<secure::ClientToken>> Mover::TokenFor(const NodeAddress& node) const {
  if (!gate_->required()) return std::optional<secure::ClientToken>();
  const std::uint64_t now = gate_->unix_now();
  const auto ring = gate_->keys();
  const secure::TokenKey* const key = ring->Newest(now);
  if (key == nullptr) return Status(StatusCode::kUnavailable, "no key is valid");
  const secure::Grant grant{.client_id = random_(),
                            .roles = secure::Role::kOperate,
                            .packets_per_second = 0,
                            .subjects = "*",
                            .audience = node.name};
  auto token = secure::MakeToken(key->id, key->key, std::min(key->expires, now + kTokenSeconds),
                                 grant, secure::SystemRandom());
  if (!token.ok()) return token.status();
  return std::optional(*std::move(token));
}

asio::awaitable<void> Mover::Connect(NodeAddress node, Time patience) {
  auto token = TokenFor(node);
  Status status = token.status();
  if (status.ok()) {
    auto link = std::make_shared<NodeLink>(
        io_,
        NodeLink::Options{.node = node,
                          .session = random_(),
                          .token = *std::move(token),
                          .on_answer = [this, name = node.name](std::uint32_t number, bool accepted,
                                                                const std::string& why) {
                            handovers_.OnAnswer(name, number, accepted, why);
                          }});
    status = co_await link->Connect(patience);
    if (status.ok()) {
      links_[node.name] = std::move(link);
    } else {
      link->Close();
    }
  }
  handovers_.OnLink(node.name, status);
}

void Mover::Send(const std::string& node, std::span<const std::uint8_t> message) {
  if (const auto link = links_.find(node); link != links_.end()) link->second->Send(message);
}

bool Mover::HasFailed(const std::string& node) const {
  const auto link = links_.find(node);
  return link != links_.end() && link->second->failed();
}

void Mover::Close(const std::string& node) {
  const auto link = links_.find(node);
  if (link == links_.end()) return;
  link->second->Close();
  links_.erase(link);
}

}  // namespace furrow::server
