// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_set>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>

#include "base/status.h"
#include "server/core/fair_share.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/net/tcp/tcp_session.h"
#include "server/session/hub.h"

namespace furrow::server {

// Accepts TCP connections, at most Limits::max_connections at a time, shared fairly between hosts,
// and owns their sessions.
class TcpServer {
 public:
  // `io`, `hub` and `metrics` must outlive the server. All functions run on the thread of `io`.
  TcpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics);

  // Listens at `endpoint`. Errors: kUnavailable; the message names the address and the port.
  [[nodiscard]] Status Open(const asio::ip::tcp::endpoint& endpoint);
  // The port that it listens on.
  [[nodiscard]] std::uint16_t port() const;
  // Starts accepting.
  void Start();

  // Stops accepting. Open connections send what is queued and close.
  void Drain();
  // Closes all connections immediately.
  void CloseAll();
  [[nodiscard]] std::size_t num_sessions() const { return sessions_.size(); }

 private:
  asio::awaitable<void> Accept();
  void Refuse(asio::ip::tcp::socket socket);

  asio::io_context& io_;
  asio::ip::tcp::acceptor acceptor_;
  const Limits limits_;
  Hub* const hub_;
  Metrics* const metrics_;
  FairShare shares_;  // of the sessions
  std::unordered_set<std::shared_ptr<TcpSession>> sessions_;
};

}  // namespace furrow::server
