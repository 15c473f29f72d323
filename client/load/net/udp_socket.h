// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <ctime>
#include <vector>

#include <sys/socket.h>

#include "client/load/net/arrival_clock.h"
#include "client/load/net/socket.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/messages/limits.h"

namespace furrow::load {

// A connected UDP socket. Send() gives up with kTimeout where the system has no room.
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
  static constexpr std::size_t kBufferBytes = 2048;  // beyond any datagram of the protocol

  [[nodiscard]] client::IoStatus SendDatagram(std::span<const std::uint8_t> datagram);
  // Takes what is there, a batch at most. kTimeout: nothing is; kNoConnection: refused.
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
  std::size_t filled_ = 0;  // of the batch
  std::size_t taken_ = 0;
  ArrivalClock clock_;  // of the batch
  std::int64_t arrived_ns_ = 0;
  bool drained_ = false;  // the last batch was not full: nothing is left until the next wait
  std::uint32_t overrun_ever_ = 0;
  std::uint64_t overrun_ = 0;
  std::array<std::uint8_t, protocol::kMaxDatagramBytes> datagram_{};
  protocol::Unbundler unbundler_;  // of the datagram taken last
  protocol::Reassembler reassembler_;
  std::uint32_t next_message_id_ = 0;
};

}  // namespace furrow::load
