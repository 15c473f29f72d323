// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/steady_timer.hpp>

#include "protocol/framing/tcp_framing.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/net/tcp/stream_socket.h"
#include "server/session/hub.h"
#include "server/session/peers/outbox.h"

namespace furrow::server {

// One TCP connection: a reader, a writer and a watchdog coroutine, and a bounded outbox between the
// hub and the writer. Runs on the thread of the socket's event loop, except for the functions of
// Link, which any network thread may call.
class TcpSession : public Link, public std::enable_shared_from_this<TcpSession> {
 public:
  // `stream`: its TLS handshake is over, if it has one. `on_closed`: called once, after the
  // connection has closed.
  TcpSession(std::shared_ptr<StreamSocket> stream, const Limits& limits, Hub* hub, Metrics* metrics,
             std::function<void(const std::shared_ptr<TcpSession>&)> on_closed);

  // Adds the peer to the hub and starts the coroutines, which keep this object alive.
  void Start();
  // Sends what is queued, then closes. `linger`: first reads and ignores input until the peer
  // closes, because closing with unread input would reset the connection and lose the last reply.
  void CloseAfterFlush(bool linger);
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
  std::function<void(const std::shared_ptr<TcpSession>&)> on_closed_;
  asio::steady_timer wake_;  // cancelled to wake the writer
  asio::steady_timer watch_;
  std::mutex mutex_;  // guards outbox_ and writing_, which publishing threads use
  Outbox outbox_;
  protocol::FrameReader frames_;
  std::vector<std::uint8_t> in_;
  std::vector<std::uint8_t> message_;
  std::vector<std::uint8_t> out_;  // frames being written
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
