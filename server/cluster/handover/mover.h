// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>

#include "base/status.h"
#include "protocol/secure/session/secure_client.h"
#include "server/cluster/handover/handovers.h"
#include "server/cluster/handover/node_link.h"
#include "server/core/time.h"
#include "server/session/access/token_gate.h"
#include "server/session/hub.h"

namespace furrow::server {

// Runs Handovers on an event loop, between a hub and links to other nodes. Runs on the thread of
// shard 0.
class Mover : private DepartingSubjects, private NodeLinks {
 public:
  // `gate`, `hub`: not null; outlive the mover.
  Mover(asio::io_context& io, const TokenGate* gate, Hub* hub,
        std::function<std::uint64_t()> random)
      : io_(io), gate_(gate), hub_(hub), random_(std::move(random)) {}
  ~Mover() override;
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;

  // Moves all subjects (Handovers::Begin()).
  [[nodiscard]] asio::awaitable<void> Run();
  void EndBy(Time end) { handovers_.EndBy(end); }
  [[nodiscard]] bool running() const { return handovers_.running(); }

  // For people. Safe on any thread.
  struct Progress {
    std::uint32_t moved = 0;
    std::string why;  // a subject could not be moved last time; empty: none
  };
  [[nodiscard]] Progress progress() const;

 private:
  // Of DepartingSubjects.
  void TakeNothingNew() override { hub_->TakeNothingNew(); }
  [[nodiscard]] std::vector<std::string> SubjectNames() override { return hub_->SubjectNames(); }
  [[nodiscard]] Place SuccessorOf(const std::string& subject, Time now,
                                  const std::set<std::string>& without) override {
    return hub_->SuccessorOf(subject, now, without);
  }
  [[nodiscard]] bool WriteState(const std::string& subject, std::uint32_t number,
                                std::vector<std::uint8_t>& message) override {
    return hub_->WriteState(subject, number, message);
  }
  [[nodiscard]] Status HandOver(const std::string& subject, const NodeAddress& node,
                                std::uint32_t number, std::vector<std::uint8_t>& message,
                                Time now) override {
    return hub_->HandOver(subject, node, number, message, now);
  }
  // Of NodeLinks.
  void Open(const NodeAddress& node, Time patience) override;
  void Send(const std::string& node, std::span<const std::uint8_t> message) override;
  [[nodiscard]] bool HasFailed(const std::string& node) const override;
  void Close(const std::string& node) override;

  asio::awaitable<void> Connect(NodeAddress node, Time patience);
  [[nodiscard]] Result<std::optional<protocol::secure::ClientToken>> TokenFor(
      const NodeAddress& node) const;
  void Note();

  asio::io_context& io_;
  const TokenGate* const gate_;
  Hub* const hub_;
  const std::function<std::uint64_t()> random_;
  std::map<std::string, std::shared_ptr<NodeLink>> links_;  // by node
  Handovers handovers_{this, this};
  Handovers::Progress noted_;  // what progress_ says
  mutable std::mutex mutex_;   // guards progress_
  Progress progress_;
};

}  // namespace furrow::server
