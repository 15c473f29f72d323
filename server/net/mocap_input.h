// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "protocol/mocap/adapter.h"
#include "server/core/metrics.h"
#include "server/net/sender_gate.h"
#include "server/session/hub.h"

namespace furrow::server {

// A UDP port that speaks a foreign wire: datagrams to an adapter, its frames to the hub, as poses
// of a peer that nobody answers. Whom it listens to is the gate's matter; what that turns away is
// counted, and named in the log once a holder.
class MocapInput {
 public:
  // `flag` names the port in errors ("--vmc").
  MocapInput(asio::io_context& io, std::string flag,
             std::unique_ptr<protocol::mocap::MocapAdapter> adapter, SenderGate gate, Hub* hub,
             Metrics* metrics);

  // Errors: kUnavailable, naming address and port.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint);
  [[nodiscard]] std::uint16_t port() const;
  void Start();
  void Close();
  // Gives out frames that wait for an end that does not come. About every 10 ms.
  void Tick(Time now);

 private:
  class NoLink : public Link {
   public:
    void SendReply(std::span<const std::uint8_t>) override {}
    int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
      return 0;
    }
    void DropFrames(std::uint64_t) override {}
  };

  asio::awaitable<void> Read();
  void OnDatagram(std::span<const std::uint8_t> bytes, const asio::ip::address& sender, Time now);
  void TurnAway(const asio::ip::address& sender);
  void Count();

  asio::io_context& io_;
  asio::ip::udp::socket socket_;
  const std::string flag_;
  const std::unique_ptr<protocol::mocap::MocapAdapter> adapter_;
  SenderGate gate_;
  bool has_named_intruder_ = false;  // in the log, since the port changed hands
  Hub* const hub_;
  Metrics* const metrics_;
  NoLink link_;
  PeerId peer_ = 0;
  protocol::mocap::AdapterCounters counted_;  // what the metrics have already
  std::array<std::uint8_t, 65536> buffer_;
};

}  // namespace furrow::server
