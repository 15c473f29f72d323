// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <unordered_map>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "protocol/fragment.h"
#include "server/config.h"
#include "server/metrics.h"
#include "server/net/udp_batch.h"
#include "server/net/udp_sender.h"
#include "server/session/hub.h"
#include "wrinkle/status.h"

namespace furrow::server {

// The UDP side of the wire: datagrams in and out by batches, fragments put together, peers by
// address.
//
// Garbage costs one look at an envelope: an address becomes a peer only with a well-formed one, and
// at most Limits::max_udp_peers are remembered.
class UdpServer {
 public:
  // `recording` (may be null) is told of every datagram with an envelope of ours.
  UdpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
            RecordingTap* recording = nullptr);
  ~UdpServer();
  UdpServer(const UdpServer&) = delete;
  UdpServer& operator=(const UdpServer&) = delete;

  // Errors: kUnavailable, naming address and port.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint);
  [[nodiscard]] std::uint16_t port() const;
  void Start();
  void Close();

  // What `work` sends to peers leaves together, when it ends.
  template <class Work>
  void Together(Work work) {
    gathering_ = true;
    work();
    gathering_ = false;
    SendAll();
  }

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
  void SendAll();
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
  UdpBatch batch_;
  UdpSender sender_;
  bool gathering_ = false;  // what goes out waits for the end of the batch that is worked on
  protocol::Reassembler reassembler_;
  std::unordered_map<Address, std::unique_ptr<UdpPeer>, AddressHash> peers_;
};

}  // namespace furrow::server
