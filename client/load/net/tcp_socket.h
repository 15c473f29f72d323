// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "client/load/net/socket.h"
#include "protocol/framing/tcp_framing.h"
#include "protocol/messages/limits.h"

namespace furrow::load {

// A connected TCP socket. Send() waits for the other end, but not longer than five seconds.
class TcpSocket : public Socket {
 public:
  explicit TcpSocket(Descriptor descriptor);

  [[nodiscard]] client::IoStatus Send(std::span<const std::uint8_t> message) override;
  [[nodiscard]] client::IoStatus Receive(std::span<const std::uint8_t>& message,
                                         std::chrono::milliseconds timeout) override;
  [[nodiscard]] int descriptor() const override { return descriptor_.get(); }
  [[nodiscard]] bool holds() const override { return !unread_.empty(); }
  [[nodiscard]] std::int64_t arrived_ns() const override { return read_ns_; }

 private:
  [[nodiscard]] client::IoStatus Fill(std::chrono::milliseconds timeout);

  Descriptor descriptor_;
  std::vector<std::uint8_t> outgoing_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(64 * 1024);
  std::span<const std::uint8_t> unread_;
  std::int64_t read_ns_ = 0;  // when that was
  bool drained_ = false;      // the last read was not full: nothing is left until the next wait
  protocol::FrameReader frames_{protocol::kMaxReplyBytes};
};

}  // namespace furrow::load
