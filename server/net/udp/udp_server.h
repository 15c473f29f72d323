// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "protocol/framing/fragment.h"
#include "server/core/fair_share.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/net/udp/udp_batch.h"
#include "server/net/udp/udp_sender.h"
#include "server/session/hub.h"
#include "server/session/peers/reception.h"

namespace furrow::server {

// The UDP socket of one shard: receives and sends datagrams in batches, reassembles fragments, and
// keeps one peer per address.
//
// An address becomes a peer when it has proved that it receives what is sent to it (Reception). A
// peer has one session number, which it alone knows: datagrams with another one are a stranger's.
// At most Limits::max_udp_peers peers are remembered, shared fairly between hosts.
class UdpServer : public BufferedSender {
 public:
  // `recording`: optional; receives every datagram of a peer.
  UdpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
            RecordingTap* recording = nullptr, int shard = 0);
  ~UdpServer() override;
  UdpServer(const UdpServer&) = delete;
  UdpServer& operator=(const UdpServer&) = delete;

  // kOwn: only this socket uses the port. kShared: several sockets of this daemon use the port, and
  // the kernel assigns each sender to one of them (SO_REUSEPORT).
  enum class Port { kOwn, kShared };
  // Errors: kUnavailable; the message names the address and the port. A kShared port must not be in
  // use by a socket that does not share it.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint, Port port = Port::kOwn);
  // Lets other sockets open the port as kShared from now on.
  [[nodiscard]] Status Share();
  // Sets the servers of all shards. What a shard publishes leaves through the shard's own socket,
  // even if the receiving peer belongs to another shard. Call it before Start().
  void Join(std::vector<UdpServer*> by_shard) { by_shard_ = std::move(by_shard); }
  [[nodiscard]] std::uint16_t port() const;
  // Drops the datagrams that have arrived since Open(). Call it before Start().
  void DropWaiting();
  // Starts reading. Fatal errors propagate out of the event loop.
  void Start();
  // Stops reading and closes the socket.
  void Close();

  // Sends the shard's messages to UDP peers.
  void Flush() override;

  // Forgets idle peers and incomplete messages. Call it about once per second.
  void Expire(Time now);

 private:
  class UdpPeer;
  using Address = UdpAddress;
  struct AddressHash {
    std::size_t operator()(const Address& address) const {
      return std::hash<std::string_view>()(
          {reinterpret_cast<const char*>(address.data()), address.size()});
    }
  };

  asio::awaitable<void> Read();
  void OnDatagram(std::span<const std::uint8_t> bytes, const asio::ip::udp::endpoint& sender,
                  Time now);
  static Address AddressOf(const asio::ip::udp::endpoint& sender);
  UdpPeer* Find(const Address& address, std::uint64_t session);
  UdpPeer* Receive(const Address& address, const asio::ip::udp::endpoint& sender,
                   std::uint64_t session, std::span<const std::uint8_t> bytes, Time now);
  UdpPeer* Add(const Address& address, const asio::ip::udp::endpoint& sender, std::uint64_t session,
               Time now);
  void Forget(const UdpPeer& peer);

  asio::io_context& io_;
  asio::ip::udp::socket socket_;
  Hub* const hub_;
  Metrics* const metrics_;
  RecordingTap* const recording_;
  const int shard_;
  std::vector<UdpServer*> by_shard_;
  UdpBatch batch_;
  UdpSender sender_;
  Reception reception_;
  FairShare shares_;                 // of the peers
  std::uint64_t num_strangers_ = 0;  // that were answered
  protocol::Reassembler reassembler_;
  std::unordered_map<Address, std::unique_ptr<UdpPeer>, AddressHash> peers_;
};

}  // namespace furrow::server
