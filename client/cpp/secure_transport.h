// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>

#include "client/cpp/datagram_socket.h"
#include "client/cpp/transport.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/secure/session/secure_client.h"

namespace furrow::client {

// Messages over UDP in a secure session (STANDARD.md section 15). The session begins, and begins
// again after a restart of the daemon, inside of Receive(); generation() counts the sessions.
class SecureTransport : public Transport {
 public:
  explicit SecureTransport(const protocol::secure::ClientToken& token);

  [[nodiscard]] asio::error_code Connect(const std::string& host, std::uint16_t port) {
    return socket_.Connect(host, port);
  }
  // Waits for a session. False: there is none at the deadline, or the daemon refuses the token in a
  // way that lasts; see failure() and refusal().
  [[nodiscard]] bool Await(DatagramSocket::Clock::time_point deadline);

  [[nodiscard]] IoStatus Send(std::span<const std::uint8_t> message) override;
  [[nodiscard]] IoStatus Receive(std::span<const std::uint8_t>& message,
                                 std::chrono::milliseconds timeout) override;
  [[nodiscard]] bool takes_bundles() const override { return true; }
  [[nodiscard]] bool connected() const override { return client_.connected(); }
  [[nodiscard]] std::uint64_t generation() const override { return generation_; }
  [[nodiscard]] std::string failure() const override;
  [[nodiscard]] protocol::secure::Refusal refusal() const override { return refusal_; }
  ~SecureTransport() override;

 private:
  using Clock = DatagramSocket::Clock;

  IoStatus Maintain(Clock::time_point now);
  void OnDatagram(std::span<std::uint8_t> datagram, Clock::time_point now);

  DatagramSocket socket_;
  protocol::secure::SecureClient client_;
  std::uint64_t generation_ = 0;
  protocol::secure::Refusal refusal_ = protocol::secure::Refusal::kNone;
  bool port_closed_ = false;       // while there is no session
  std::span<std::uint8_t> inner_;  // of the last datagram, until Receive() has used it
  std::array<std::uint8_t, protocol::secure::kMaxPacketBytes> packet_{};
  protocol::Unbundler unbundler_;
  protocol::Reassembler reassembler_;
  std::uint32_t next_message_id_ = 0;
};

}  // namespace furrow::client
