// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "protocol/mocap/adapter.h"
#include "server/core/metrics.h"
#include "server/net/mocap_report.h"
#include "server/net/sender_gate.h"
#include "server/session/hub.h"

namespace furrow::server {

// A UDP port for a foreign motion-capture protocol (VMC, Live Link Face). An adapter turns
// datagrams into frames, and the hub receives them as frames of a peer to which it never replies. A
// SenderGate decides who may send; rejected datagrams are counted, and logged once per holder of
// the port. Runs on the thread of `io`, shard 0.
class MocapInput {
 public:
  // `flag`: names the port in messages, for example "--vmc". `hub` and `metrics` must outlive this
  // object.
  MocapInput(asio::io_context& io, std::string flag,
             std::unique_ptr<protocol::mocap::MocapAdapter> adapter, SenderGate gate, Hub* hub,
             Metrics* metrics);

  // Errors: kUnavailable, naming address and port.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint);
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] MocapReport Report(Time now) const;
  // Asks another gate from now on. Nobody holds the port then.
  void SetGate(SenderGate gate) {
    gate_ = std::move(gate);
    adapter_->Forget();  // half a frame of the former sender must not mix with the next one
    has_logged_rejected_ = false;
  }
  // Lets this sender hold the port at once (SenderGate::Give()). `sender`: a numeric address.
  // Errors: kInvalidArgument (not an address), kUnsupported (it may not hold the port).
  [[nodiscard]] Status Give(const std::string& sender, Time now);
  // Starts reading. Precondition: Open() succeeded.
  void Start();
  // Stops reading and closes the port.
  void Close();
  // Completes frames without an end-of-frame mark. Call it about every 10 ms.
  void Tick(Time now);

 private:
  class NullLink : public Link {
   public:
    void SendReply(std::span<const std::uint8_t>) override {}
    int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
      return 0;
    }
    void DropFrames(std::uint64_t) override {}
  };

  asio::awaitable<void> Read();
  void OnDatagram(std::span<const std::uint8_t> bytes, const asio::ip::address& sender, Time now);
  void Reject(const asio::ip::address& sender);
  void UpdateMetrics();
  void CountUnderstood(const asio::ip::address& sender, Time now);

  asio::io_context& io_;
  asio::ip::udp::socket socket_;
  const std::string flag_;
  const std::unique_ptr<protocol::mocap::MocapAdapter> adapter_;
  SenderGate gate_;
  bool has_logged_rejected_ = false;  // since the port changed hands
  Hub* const hub_;
  Metrics* const metrics_;
  // The last datagram of a kind, for Report().
  struct Arrival {
    asio::ip::address sender;
    Time at{0};
  };
  std::uint64_t packets_ = 0;
  std::uint64_t rejected_ = 0;
  double rate_hz_ = 0.0;
  Time second_{0};     // when the second that is being counted began
  int in_second_ = 0;  // understood datagrams in it
  std::optional<Arrival> last_;
  std::optional<Arrival> last_malformed_;
  std::optional<Arrival> last_rejected_;
  NullLink link_;
  PeerId peer_ = 0;
  protocol::mocap::AdapterCounters counted_;  // already added to the metrics
  std::array<std::uint8_t, 65536> buffer_;
};

}  // namespace furrow::server
