// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include <sys/socket.h>

#include "base/process/descriptor.h"
#include "client/net/arrival_clock.h"
#include "client/net/socket.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/messages/limits.h"
#include "protocol/secure/session/secure_client.h"

namespace furrow::net {

// A connected UDP socket. Send() never blocks: it returns kTimeout if the send buffer is full.
class UdpSocket : public Socket {
 public:
  // `token`: null, or that of the secure session that carries all messages.
  explicit UdpSocket(Descriptor descriptor, const client::Token* token = nullptr);

  // Waits for the secure session, if there is to be one. Returns why there is none; empty: all is
  // well.
  [[nodiscard]] std::string AwaitSession(std::chrono::milliseconds timeout);
  [[nodiscard]] bool connected() const override { return !secure_ || secure_->connected(); }
  [[nodiscard]] std::uint64_t generation() const override { return generation_; }
  [[nodiscard]] protocol::secure::Refusal refusal() const override { return refusal_; }

  [[nodiscard]] client::IoStatus Send(std::span<const std::uint8_t> message) override;
  [[nodiscard]] client::IoStatus Receive(std::span<const std::uint8_t>& message,
                                         std::chrono::milliseconds timeout) override;
  [[nodiscard]] bool takes_bundles() const override { return true; }
  [[nodiscard]] int descriptor() const override { return descriptor_.get(); }
  [[nodiscard]] bool holds() const override { return taken_ < filled_ || unbundler_.has_more(); }
  [[nodiscard]] std::int64_t arrived_ns() const override { return arrived_ns_; }
  [[nodiscard]] std::uint64_t overrun() const override { return overrun_; }

 private:
  static constexpr std::size_t kBatch = 32;
  static constexpr std::size_t kBufferBytes = 2048;  // larger than any datagram of the protocol

  // Sends what the secure session has to send.
  void Maintain();
  // The datagram inside of a sealed one; empty if there is none.
  [[nodiscard]] std::span<std::uint8_t> Open(std::span<std::uint8_t> datagram);
  [[nodiscard]] client::IoStatus SendSealed(std::size_t inner_bytes);
  [[nodiscard]] client::IoStatus SendDatagram(std::span<const std::uint8_t> datagram);
  // Reads one batch of waiting datagrams. kTimeout: none is waiting. kNoConnection: the peer's port
  // is closed.
  [[nodiscard]] client::IoStatus Fill();
  void ReadOverrun(msghdr* header);

  struct Control {
    alignas(cmsghdr)
        std::array<char, CMSG_SPACE(sizeof(std::uint32_t)) + CMSG_SPACE(sizeof(timespec))> bytes;
  };

  Descriptor descriptor_;
  std::vector<std::uint8_t> buffer_;
  std::array<mmsghdr, kBatch> headers_{};
  std::array<iovec, kBatch> slices_{};
  std::array<Control, kBatch> controls_{};
  std::size_t filled_ = 0;  // datagrams in the batch
  std::size_t taken_ = 0;   // datagrams already returned
  ArrivalClock clock_;
  std::int64_t arrived_ns_ = 0;
  bool drained_ = false;            // the last batch was not full, so no datagram is left for now
  std::uint32_t overrun_ever_ = 0;  // the kernel's counter, which wraps
  std::uint64_t overrun_ = 0;
  // Room for a datagram, and around it for the header and tag of a sealed one.
  std::array<std::uint8_t, protocol::secure::kMaxPacketBytes> packet_{};
  std::optional<protocol::secure::SecureClient> secure_;
  bool began_ = false;  // there was a session
  std::uint64_t generation_ = 1;
  std::int64_t maintained_us_ = 0;
  protocol::secure::Refusal refusal_ = protocol::secure::Refusal::kNone;
  protocol::Unbundler unbundler_;  // splits the datagram taken last
  protocol::Reassembler reassembler_;
  std::uint32_t next_message_id_ = 0;
};

}  // namespace furrow::net
