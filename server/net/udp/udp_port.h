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
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/net/udp/udp_server.h"
#include "server/saved/saved_state.h"
#include "server/session/hub.h"

namespace furrow::server {

// The UDP port of a daemon: one socket per shard of the hub. The caller's event loop serves shard
// 0; every other shard has a thread. With SO_REUSEPORT the kernel delivers all datagrams of one
// sender to the same socket, so a sender stays in one shard.
class UdpPort {
 public:
  // `shards`: the number of shards of the hub; each may have an equal part of
  // Limits::max_udp_peers. `recording`: optional; receives every datagram with a valid envelope.
  // `secure`: null, or sessions for the same number of shards. `requires_token`: plain datagrams
  // are refused. All pointers must outlive the port.
  UdpPort(asio::io_context& io, int shards, const Limits& limits, Hub* hub, Metrics* metrics,
          RecordingTap* recording, SecureSessions* secure = nullptr, bool requires_token = false);
  ~UdpPort();
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  // See UdpServer::SetBusyPoll(). Call it before Open() or Adopt().
  void SetBusyPoll(Time time);
  // Errors: kUnavailable; the message names the address and the port.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint);
  // Uses the sockets of a former daemon instead, one per shard, with all that waits in them.
  // Errors: kUnavailable.
  [[nodiscard]] Status Adopt(std::span<const int> sockets);
  [[nodiscard]] std::uint16_t port() const { return servers_.front()->port(); }
  // Starts reading, and the threads of shards 1 and above.
  void Start();
  // For a restart: stops reading, joins the threads of other shards and does the work that they
  // have left. From then on, only the calling thread uses the hub. Other shards may have passed
  // work to the caller's event loop before.
  void Leave();
  // Saves the peers and the numbers of the sockets for the next daemon, and ends all secure
  // sessions. After Leave(), when the work that was passed is done.
  void Save(SavedState* state);
  [[nodiscard]] std::vector<int> sockets();
  // Goes on with the peers of the former daemon.
  void Resume(const SavedState& state, Hub::ResumedPeers* peers, Time now);
  // Stops reading and joins the threads.
  void Close();

 private:
  [[nodiscard]] asio::io_context& LoopOf(std::size_t shard) {
    return shard == 0 ? io_ : *loops_[shard - 1];
  }
  void Run(asio::io_context& loop);
  void Join();
  asio::awaitable<void> ExpireLoop(std::size_t shard);
  asio::awaitable<void> ReleaseLoop(std::size_t shard);

  asio::io_context& io_;
  Hub* const hub_;
  Metrics* const metrics_;
  SecureSessions* const secure_;
  std::vector<std::unique_ptr<asio::io_context>> loops_;  // of shards 1 and above
  std::vector<std::unique_ptr<UdpServer>> servers_;       // by shard
  std::vector<std::thread> threads_;
};

}  // namespace furrow::server
