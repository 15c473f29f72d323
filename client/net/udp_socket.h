// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <ctime>
#include <vector>

#include <sys/socket.h>

#include "client/net/arrival_clock.h"
#include "client/net/descriptor.h"
#include "client/net/socket.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/messages/limits.h"

namespace furrow::net {

// A connected UDP socket. Send() never blocks: it returns kTimeout if the send buffer is full.
class UdpSocket : public Socket {
 public:
  explicit UdpSocket(Descriptor descriptor);

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
  std::array<std::uint8_t, protocol::kMaxDatagramBytes> datagram_{};
  protocol::Unbundler unbundler_;  // splits the datagram taken last
  protocol::Reassembler reassembler_;
  std::uint32_t next_message_id_ = 0;
};

}  // namespace furrow::net
