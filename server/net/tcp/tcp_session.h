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
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>

#include "protocol/framing/tcp_framing.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/session/hub.h"
#include "server/session/peers/outbox.h"

namespace furrow::server {

// One TCP connection: three coroutines, each with one concern (reader, writer, watchdog), and a
// bounded outbox between the hub and the writer.
class TcpSession : public Link, public std::enable_shared_from_this<TcpSession> {
 public:
  // `on_closed` is called once, when the connection has ended.
  TcpSession(asio::ip::tcp::socket socket, const Limits& limits, Hub* hub, Metrics* metrics,
             std::function<void(const std::shared_ptr<TcpSession>&)> on_closed);

  void Start();
  // Sends what waits, then closes. `linger`: reads on (and ignores) until the peer has closed, so
  // that the last answer is not lost to a reset.
  void CloseAfterFlush(bool linger);
  // Ends at once.
  void Close();

  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                int lane) override;
  void DropFrames(std::uint64_t key) override;
  [[nodiscard]] bool IsStuck(Time now) const override;

 private:
  enum class State { kOpen, kFlushing, kLingering, kClosed };

  asio::awaitable<void> Read();
  asio::awaitable<void> Write();
  bool TakeOut();
  void SetWriting(bool writing);
  void Wake();
  asio::awaitable<void> Watch();
  bool OnBytes(std::span<const std::uint8_t> bytes, Time now);
  bool IsOverdue(Time now);

  asio::ip::tcp::socket socket_;
  const Limits limits_;
  Hub* const hub_;
  Metrics* const metrics_;
  std::function<void(const std::shared_ptr<TcpSession>&)> on_closed_;
  asio::steady_timer wake_;  // the writer's: cancelled when there is something to do
  asio::steady_timer watch_;
  std::mutex mutex_;  // of what other threads that publish reach: what waits, and who writes it
  Outbox outbox_;
  protocol::FrameReader frames_;
  std::vector<std::uint8_t> in_;
  std::vector<std::uint8_t> message_;
  std::vector<std::uint8_t> out_;  // frames that are being written
  PeerId peer_ = 0;
  std::atomic<State> state_ = State::kOpen;
  bool linger_ = false;
  bool writing_ = false;
  std::atomic<bool> woken_ = false;  // by another thread, which has posted so
  std::thread::id thread_;           // that all runs on but Link
  Time write_started_{0};
  Time closing_since_{0};
};

}  // namespace furrow::server
