// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>

#include "protocol/messages/cluster_messages.h"
#include "server/cluster/handover/mover.h"
#include "server/core/time.h"
#include "server/session/hub.h"

namespace furrow::server {

// The end of a daemon. In a cluster, the subjects move to other nodes first. All peers hear
// goodbye, queued messages leave until a deadline, and the event loop ends.
//
// Belongs to the thread of shard 0, except OnDrainRequest().
class Shutdown {
 public:
  struct Parts {
    asio::io_context* io = nullptr;
    Hub* hub = nullptr;
    std::unique_ptr<Mover> mover;      // null: the daemon is alone
    std::function<Time()> drain_time;  // until the deadline, asked for at the beginning
    std::function<void()> on_begin;    // before subjects move
    // For a restart that clients do not notice. `let_go` frees memory, so that the process ends at
    // once; false: call it again. `leave` ends the work on sockets; false: call it
    // again. `save` leaves everything to the next daemon; false: it failed, and the daemon just
    // ends. `owes_frames`: clients that must connect again still wait for frames that may not be
    // left out. Empty: the daemon just ends.
    std::function<bool()> let_go;
    std::function<bool()> leave;
    std::function<bool()> save;
    std::function<bool()> owes_frames;
    std::function<void()> stop;        // after the goodbyes: nothing more is received
    std::function<bool()> is_sending;  // queued messages are still on their way
    std::function<void()> close;       // whatever has not left by then is lost
  };
  explicit Shutdown(Parts parts) : parts_(std::move(parts)) {}

  // Begins the end; a second call changes nothing.
  void Request();
  // Answers a client that wants this node to be empty. `begin`: moves all subjects, however long
  // that takes, and then ends. In a cluster only. Runs on any shard's thread, under the exclusive
  // lock.
  [[nodiscard]] protocol::DrainState OnDrainRequest(bool begin);

  [[nodiscard]] bool has_begun() const { return has_begun_; }
  // When the rest is given up. Only after the beginning.
  [[nodiscard]] Time deadline() const { return deadline_; }

 private:
  asio::awaitable<void> Run();
  asio::awaitable<void> MoveAndEnd();
  asio::awaitable<void> MoveInTime();
  asio::awaitable<void> LetGo();
  asio::awaitable<bool> LeaveAll();
  asio::awaitable<void> Flush(bool has_left);

  const Parts parts_;
  bool has_begun_ = false;
  bool mover_has_started_ = false;                    // set after moves_
  std::atomic<bool> moves_ = false;                   // subjects are moved to other nodes
  std::atomic<bool> client_knows_all_moved_ = false;  // the one that asked for the drain
  Time deadline_{0};
};

}  // namespace furrow::server
