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
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/net/udp/udp_batch.h"
#include "server/net/udp/udp_sender.h"
#include "server/session/hub.h"

namespace furrow::server {

// The UDP side of the wire, of one lane of the hub: datagrams in and out by batches, fragments put
// together, peers by address.
//
// Garbage costs one look at an envelope: an address becomes a peer only with a well-formed one, and
// at most Limits::max_udp_peers are remembered.
class UdpServer : public Outlet {
 public:
  // `recording` (may be null) is told of every datagram with an envelope of ours.
  UdpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
            RecordingTap* recording = nullptr, int lane = 0);
  ~UdpServer() override;
  UdpServer(const UdpServer&) = delete;
  UdpServer& operator=(const UdpServer&) = delete;

  // Whether the port is this socket's alone, or others of the group have it too: the system then
  // spreads who sends over them, each to the same one always.
  enum class Port { kOwn, kShared };
  // Errors: kUnavailable, naming address and port; also where the port is to be shared and somebody
  // has it who opened it otherwise.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint, Port port = Port::kOwn);
  // From here on others may open the port as kShared, until it is closed.
  [[nodiscard]] Status Share();
  // The servers of all lanes, by lane: what a lane publishes leaves by its own socket, whichever
  // the peer's datagrams come to. Before Start().
  void Join(std::vector<UdpServer*> by_lane) { by_lane_ = std::move(by_lane); }
  [[nodiscard]] std::uint16_t port() const;
  // What came since Open() is lost. Before Start().
  void DropWaiting();
  // What nobody can go on from is thrown by the loop.
  void Start();
  void Close();

  // Sends what the lane has for UDP peers.
  void Flush() override;

  // Forgets idle peers and unfinished messages. Call it about once a second.
  void Expire(Time now);

 private:
  class UdpPeer;
  using Address = std::array<std::uint8_t, 18>;  // IPv6 (or mapped IPv4) and port
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
  UdpPeer* FindOrAdd(const asio::ip::udp::endpoint& sender, Time now);

  asio::io_context& io_;
  asio::ip::udp::socket socket_;
  const Limits limits_;
  Hub* const hub_;
  Metrics* const metrics_;
  RecordingTap* const recording_;
  const int lane_;
  std::vector<UdpServer*> by_lane_;
  UdpBatch batch_;
  UdpSender sender_;
  protocol::Reassembler reassembler_;
  std::unordered_map<Address, std::unique_ptr<UdpPeer>, AddressHash> peers_;
};

}  // namespace furrow::server
