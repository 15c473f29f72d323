// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>

#include "base/status.h"
#include "server/cluster/handover/node_link.h"
#include "server/core/time.h"
#include "server/session/access/token_gate.h"
#include "server/session/hub.h"

namespace furrow::server {

// Gives the subjects of this node to other nodes, one after the other:
//
// 1. The other node gets the state of the subject and says whether it takes it. The subject goes on
//    here meanwhile.
// 2. The last state leaves, the lease goes to the other node, and so do the publisher and the
//    subscribers, at the same moment.
//
// Runs on the thread of shard 0.
class Mover {
 public:
  // `gate`, `hub`: not null; outlive the mover.
  Mover(asio::io_context& io, const TokenGate* gate, Hub* hub,
        std::function<std::uint64_t()> random)
      : io_(io), gate_(gate), hub_(hub), random_(std::move(random)) {}
  ~Mover();

  // Takes nothing new and moves all subjects. Ends when no subject is left; after EndBy(), also
  // when no other one can be moved, or at that time.
  [[nodiscard]] asio::awaitable<void> Run();
  void EndBy(Time end) { end_ = end; }
  [[nodiscard]] bool running() const { return running_; }

  // For people. Safe on any thread.
  struct Progress {
    std::uint32_t moved = 0;
    std::string why;  // a subject could not be moved last time; empty: none
  };
  [[nodiscard]] Progress progress() const;

 private:
  // A message that the node has not answered yet.
  struct Sent {
    std::shared_ptr<NodeLink> link;
    std::vector<std::uint8_t> message;
    Time sent{0};
    Time give_up{0};
    std::optional<bool> accepted;
    std::string why;
    bool is_last = false;  // nobody waits for the answer
  };

  asio::awaitable<bool> MoveAll();
  asio::awaitable<Status> Move(std::string subject);
  asio::awaitable<Status> MoveTo(NodeAddress node, std::string subject);
  void Unlink(const std::string& node);
  asio::awaitable<Result<std::shared_ptr<NodeLink>>> LinkTo(NodeAddress node);
  asio::awaitable<void> Wait(Time time);  // and repeats what is not answered
  void Send(const std::shared_ptr<NodeLink>& link, std::uint32_t number,
            std::vector<std::uint8_t> message, bool is_last);
  void OnAnswer(std::uint32_t number, bool accepted, const std::string& why);
  void Repeat(Time now);
  void Note(bool moved, const std::string& why);
  [[nodiscard]] Time Patience(Time most) const;

  asio::io_context& io_;
  const TokenGate* const gate_;
  Hub* const hub_;
  const std::function<std::uint64_t()> random_;
  std::map<std::string, std::shared_ptr<NodeLink>> links_;  // by node
  std::set<std::string> silent_;                            // nodes that failed in this round
  std::map<std::uint32_t, Sent> sent_;                      // by number
  std::uint32_t next_number_ = 1;
  std::optional<Time> end_;
  std::string logged_;  // why a subject stays
  bool running_ = false;
  mutable std::mutex mutex_;  // guards progress_
  Progress progress_;
};

}  // namespace furrow::server
