// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/steady_timer.hpp>

#include "protocol/framing/tcp_framing.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/net/tcp/stream_socket.h"
#include "server/saved/saved_state.h"
#include "server/session/hub.h"
#include "server/session/peers/outbox.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// One TCP connection: a reader, a writer and a watchdog coroutine, and a bounded outbox between the
// hub and the writer. Runs on the thread of the socket's event loop, except for the functions of
// Link, which any network thread may call.
class TcpSession : public Link, public std::enable_shared_from_this<TcpSession> {
 public:
  // `stream`: its TLS handshake is over, if it has one. `on_closed`: called once, after the
  // connection has closed. `waiting`: limits what waits for the client.
  TcpSession(std::shared_ptr<StreamSocket> stream, const Limits& limits, Hub* hub, Metrics* metrics,
             WaitingBytes* waiting,
             std::function<void(const std::shared_ptr<TcpSession>&)> on_closed);

  // Adds the peer to the hub and starts the coroutines, which keep this object alive.
  void Start();
  // Goes on with a connection of the former daemon instead of Start(). `access`: by a token that it
  // has shown there; none: that of everybody. Returns the peer; 0: the connection was closed.
  [[nodiscard]] PeerId Resume(const SavedConnection& saved, std::optional<Access> access);

  // For a restart: stops reading and writing, so that the next daemon goes on with the connection.
  // False: something still reads or writes; call it again. Does nothing and returns true if the
  // connection cannot go there.
  [[nodiscard]] bool Leave();
  // What the next daemon needs besides the socket. Nothing: the connection cannot go there, it is
  // still busy, or more than `room` bytes wait for the client.
  [[nodiscard]] std::optional<SavedConnection> Save(std::size_t room);
  // True after Save(), if the next daemon goes on with the connection.
  [[nodiscard]] bool is_saved() const { return is_saved_; }
  // Goes on here after Leave() and Save(), with all that waits for the client.
  void Stay();
  [[nodiscard]] int socket() { return stream_->socket().native_handle(); }

  // Sends what is queued, then closes. `linger`: first reads and ignores input until the peer
  // closes, because closing with unread input would reset the connection and lose the last reply.
  void CloseAfterFlush(bool linger);
  // True if frames that may not be left out (kKeepAll) still wait for the client.
  [[nodiscard]] bool OwesFrames();
  // Closes immediately.
  void Close();

  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                int shard) override;
  void DropFrames(std::uint64_t key) override;
  void OnAdmitted() override;
  void Finish() override;
  void FinishSoon() override;
  [[nodiscard]] bool IsStuck(Time now) const override;

 private:
  enum class State { kOpen, kFlushing, kLingering, kClosed };

  // The coroutines, as bits.
  enum Task : unsigned { kRead = 1, kWrite = 2, kWatch = 4 };

  void Begin(std::optional<Access> access);
  // Starts those that do not run.
  void StartTasks();
  void Spawn(Task task);
  asio::awaitable<void> Perform(Task task);
  asio::awaitable<void> Read();
  asio::awaitable<void> Write();
  bool FillWriteBuffer();
  void SetWriting(bool writing);
  void Wake();
  asio::awaitable<void> Watch();
  bool OnBytes(std::span<const std::uint8_t> bytes, Time now);
  bool IsOverdue(Time now);

  const std::shared_ptr<StreamSocket> stream_;
  const Limits limits_;
  Hub* const hub_;
  Metrics* const metrics_;
  WaitingBytes* const waiting_;
  std::function<void(const std::shared_ptr<TcpSession>&)> on_closed_;
  asio::steady_timer wake_;  // cancelled to wake the writer
  asio::steady_timer watch_;
  std::mutex mutex_;  // guards outbox_ and writing_, which publishing threads use
  Outbox outbox_;
  protocol::FrameReader frames_;
  std::vector<std::uint8_t> in_;
  std::vector<std::uint8_t> message_;
  std::vector<std::uint8_t> out_;     // frames being written
  std::vector<std::uint8_t> unsent_;  // left over, before what is queued
  bool owes_frames_ = false;          // out_ may hold kKeepAll frames
  bool is_admitted_ = false;          // OnAdmitted() was called
  bool is_new_ = true;                // nothing has arrived yet
  bool leaves_ = false;
  bool is_saved_ = false;
  unsigned running_ = 0;  // tasks
  PeerId peer_ = 0;
  std::atomic<State> state_ = State::kOpen;
  bool linger_ = false;
  bool writing_ = false;
  std::atomic<bool> woken_ = false;  // another thread has posted a wake-up
  std::thread::id thread_;           // the thread that runs the coroutines
  Time write_started_{0};
  Time closing_since_{0};
};

}  // namespace furrow::server
