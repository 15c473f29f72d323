// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/net/udp/udp_server.h"
#include "server/session/hub.h"

namespace furrow::server {

// The UDP port of a daemon: one socket a lane of the hub, and but for the first, which the caller's
// loop serves, a thread each. The system gives all datagrams of one sender to one of the sockets
// (SO_REUSEPORT), so a sender lives in one lane.
class UdpPort {
 public:
  // `lanes`: those of the hub. Limits::max_udp_peers is shared out among them.
  UdpPort(asio::io_context& io, int lanes, const Limits& limits, Hub* hub, Metrics* metrics,
          RecordingTap* recording);
  ~UdpPort();
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  // Errors: kUnavailable, naming address and port.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint);
  [[nodiscard]] std::uint16_t port() const { return servers_.front()->port(); }
  void Start();
  // The threads have ended when it returns.
  void Close();

 private:
  [[nodiscard]] asio::io_context& LoopOf(std::size_t lane) {
    return lane == 0 ? io_ : *loops_[lane - 1];
  }
  void Run(asio::io_context& loop);
  asio::awaitable<void> ExpireLoop(std::size_t lane);

  asio::io_context& io_;
  std::vector<std::unique_ptr<asio::io_context>> loops_;  // of the lanes from 1 on
  std::vector<std::unique_ptr<UdpServer>> servers_;       // by lane
  std::vector<std::thread> threads_;
};

}  // namespace furrow::server
